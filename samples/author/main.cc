// Writes the bundled sample motions as BVH: poise_author_samples DIRECTORY

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>

#include "core/motion/io/clip_file.h"
#include "samples/author/samples.h"

namespace poise::samples {
namespace {

Status WriteSamples(const std::filesystem::path& directory) {
  for (const Performance& performance : AllSamples()) {
    POISE_ASSIGN_OR_RETURN(const motion::Clip clip, Perform(performance));
    const std::filesystem::path path = directory / (performance.name + ".bvh");
    POISE_RETURN_IF_ERROR(motion::WriteBvhFile(path, clip));
    fmt::print("{}: {} frames, {:.2f} s\n", path.string(), clip.num_frames(), clip.duration());
  }
  return absl::OkStatus();
}

}  // namespace
}  // namespace poise::samples

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: poise_author_samples DIRECTORY\n");
    return 2;
  }
  const poise::Status status = poise::samples::WriteSamples(argv[1]);
  if (!status.ok()) {
    fmt::print(stderr, "{}\n", poise::base::Message(status));
    return 1;
  }
  return 0;
}
