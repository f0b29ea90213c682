#include "core/motion/dataset/fold.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

namespace poise::motion {
namespace {

Status NoClips(const FoldChoice& choice, const std::set<std::string>& actions,
               const std::set<std::string>& actors) {
  if (actors.empty()) {
    return base::FailedPrecondition(
        "NO_CLIPS", "action_class",
        fmt::format("the data set has no clips of class '{}'; its actions: {}", choice.action_class,
                    fmt::join(actions, ", ")));
  }
  return base::FailedPrecondition(
      "NO_CLIPS", "hold_out",
      fmt::format("holding out '{}' leaves nothing to learn from, or is none of the actors: {}",
                  choice.held_out, fmt::join(actors, ", ")));
}

}  // namespace

StatusOr<FoldClips> ChooseFold(const std::vector<LabelledClip>& clips, const FoldChoice& choice) {
  FoldClips fold;
  std::set<std::string> actions, actors;
  for (size_t i = 0; i < clips.size(); ++i) {
    const LabelledClip& labelled = clips[i];
    actions.insert(labelled.action);
    if (!choice.action_class.empty() && !IsOfClass(labelled.action, choice.action_class)) continue;
    actors.insert(labelled.actor);
    const bool held_out = !choice.held_out.empty() && labelled.actor == choice.held_out;
    (held_out ? fold.held_out : fold.train).push_back(i);
  }
  if (fold.train.empty() || (!choice.held_out.empty() && fold.held_out.empty())) {
    return NoClips(choice, actions, actors);
  }
  actors.erase(choice.held_out);
  fold.description = fmt::format(
      "{}, actors {}{}", choice.action_class.empty() ? "all" : "class " + choice.action_class,
      fmt::join(actors, " "),
      choice.held_out.empty() ? "" : fmt::format(", {} held out", choice.held_out));
  return fold;
}

}  // namespace poise::motion
