#include "core/push/learned/pose_config.h"

namespace poise::push {

std::vector<base::Field> PoseConfig::Fields() {
  return {
      base::Number("hidden", &hidden, 4, 1024),
      base::Number("lookahead", &lookahead, 0, 60),
      base::Flag("lean_input", &lean_input),
  };
}

}  // namespace poise::push
