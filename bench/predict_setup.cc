#include "bench/predict_setup.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <utility>

#include "core/math/rotation.h"

namespace poise::bench {

namespace fs = std::filesystem;

absl::Duration Scaled(absl::Duration time) {
  const char* scale = std::getenv("POISE_BENCH_SCALE");
  return time * (scale != nullptr ? std::strtod(scale, nullptr) : 1.0);
}

double MemoryMb() {
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return static_cast<double>(resident) * static_cast<double>(sysconf(_SC_PAGESIZE)) / 1e6;
}

base::Histogram& WaitRecorder::histogram(const std::string& name, const std::string& help,
                                         const base::Labels& labels) {
  return name == "poise_predict_wait_seconds" ? *this
                                              : base::Telemetry::histogram(name, help, labels);
}

void WaitRecorder::Observe(double value) {
  std::lock_guard lock(mutex_);
  waits_ms_.push_back(1000 * value);
}

std::vector<double> WaitRecorder::TakeSorted() {
  std::lock_guard lock(mutex_);
  std::sort(waits_ms_.begin(), waits_ms_.end());
  return std::exchange(waits_ms_, {});
}

Service::Service(const std::string& name, const serving::ServingConfig& config) {
  folder = fs::temp_directory_path() / fmt::format("poise_predict_bench_{}_{}", getpid(), name);
  engine = OrDie(engine::Engine::Create(
      {.data_dir = folder, .shipped_models = POISE_MODELS_DIR, .serving = config}, telemetry));
  server::ServerConfig listen;
  listen.listen = "127.0.0.1:0";
  listen.admission.max_calls_per_peer = listen.admission.max_calls;  // all clients are one peer
  server = OrDie(server::Server::Start(listen, *engine, telemetry));
}

Service::~Service() {
  server.reset();
  engine.reset();
  std::error_code ignored;
  fs::remove_all(folder, ignored);
}

Subject ReadSubject() {
  artifacts::ModelArtifact model =
      OrDie(artifacts::ReadModelFolder(fs::path(POISE_MODELS_DIR) / kPredictModel / "1"));
  prediction::PredictorPtr predictor = OrDie(prediction::MakeTrainedPredictor(model));
  const prediction::PredictorSignature& signature = predictor->signature();
  std::vector<motion::Vec3> positions;
  std::vector<motion::Quat> rotations;
  for (int frame = 0; frame < signature.past_frames; ++frame) {
    positions.emplace_back(0.02 * frame, 1, 0);
    for (int joint = 0; joint < signature.skeleton->num_joints(); ++joint) {
      rotations.push_back(
          math::FromRotationVector({0.3 * std::sin(0.1 * frame + joint), 0.02 * frame, 0.1}));
    }
  }
  motion::Clip past = OrDie(motion::Clip::Create("walk", signature.skeleton, signature.frame_rate,
                                                 std::move(positions), std::move(rotations)));
  const double horizon = kPredictFrames / signature.frame_rate;
  return {std::move(model), std::move(predictor), std::move(past), horizon};
}

}  // namespace poise::bench
