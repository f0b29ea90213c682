#include "core/push/learned/hip_config.h"

namespace poise::push {

std::vector<base::Field> HipConfig::Fields() {
  return {
      base::Number("hidden", &hidden, 4, 1024),
      base::Number("message", &message, 1, 256),
      base::Number("message_hidden", &message_hidden, 1, 1024),
      base::Number("reach_m", &reach_m, 0.2, 10),
      base::Flag("messages", &messages),
  };
}

}  // namespace poise::push
