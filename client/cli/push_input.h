#ifndef POISE_CLIENT_CLI_PUSH_INPUT_H_
#define POISE_CLIENT_CLI_PUSH_INPUT_H_

#include <string>
#include <string_view>
#include <vector>

#include "core/api/push_spec.h"
#include "core/base/status.h"

/// How people and pushes are written on a command line and in a scene file.
namespace poise::cli {

/// Places of a formation [m]: "line:10", "diamond:13", with a spacing "line:10:0.5". Person 0 is at
/// the rear; the formation lies along +X. A line's spacing is 0.35 m, a diamond's 0.45 m; a diamond
/// has 1, 5, 13, 25, ... people in rows of 1, 3, 5, ..., 1.
/// Errors: kInvalidArgument BAD_FORMATION with field "people".
StatusOr<std::vector<motion::Vec3>> FormationPlaces(std::string_view text);

/// "PERSON:STRENGTH[:DIRECTION][@SECONDS]": strength is weak, medium, strong or newton seconds
/// ("40Ns"), direction degrees to the left of +X, the start 0. "0:strong", "2:40Ns:90@0.5".
/// Errors: kInvalidArgument BAD_PUSH with field "push".
StatusOr<api::PushForce> ParsePush(std::string_view text);

/// A scene file: {"duration_s": 2, "people": [{"id", "file", "frame", "mass_kg", "place": [x, z]}],
/// "pushes": [{"person", "start_s", "duration_s", "impulse_ns": [x, z], "height"} or
/// "0:strong"]}; files are sought beside it. What `poise push` writes can be read again.
/// Errors: kNotFound FILE_NOT_FOUND; kInvalidArgument MALFORMED_JSON, MALFORMED_SCENE, and those of
/// ReadClipFile.
StatusOr<api::PushSpec> ReadSceneFile(const std::string& path);

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_PUSH_INPUT_H_
