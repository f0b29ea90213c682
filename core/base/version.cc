#include "core/base/version.h"

namespace poise::base {

const char* Version() { return POISE_VERSION; }

}  // namespace poise::base
