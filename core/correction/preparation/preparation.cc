#include "core/correction/preparation/preparation.h"

#include "core/correction/preparation/body_height.h"
#include "core/correction/preparation/foot_plant.h"
#include "core/correction/preparation/limb_separation.h"

namespace poise::correction {

motion::Clip PrepareMotion(const motion::Clip& clip, const physics::HumanoidModel& model,
                           const PreparationConfig& config) {
  if (!config.enabled) return clip;
  motion::Clip prepared = StandOnFloor(clip, model, config);
  prepared = SeparateLimbs(std::move(prepared), model, config);
  return PlantFeet(std::move(prepared), model, config);
}

}  // namespace poise::correction
