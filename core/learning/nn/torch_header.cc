// Owner of the precompiled LibTorch header (cmake/PoiseTargets.cmake).
#include <torch/torch.h>
