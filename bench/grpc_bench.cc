#include <fmt/format.h>
#include <grpcpp/create_channel.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <vector>

#include "bench/bench_clip.h"
#include "bench/benchmark.h"
#include "core/engine/engine.h"
#include "core/pipeline/augment.h"
#include "poise/v1/augmentation_service.grpc.pb.h"
#include "proto/convert/clip_convert.h"
#include "server/log.h"
#include "server/server.h"

/// What the way over gRPC costs: variants per second of wall clock from a server with one compute
/// thread, read and parsed by one client over loopback, against the same flow called in a loop on
/// one thread. Rounds of both take turns, so that a busy machine slows both, and the ratio is the
/// median over the pairs.
namespace poise::bench {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kFrames = 361;
constexpr double kFrameRate = 120;
constexpr int kVariantsPerRound = 3000;
constexpr int kRounds = 9;
constexpr char kMethod[] = "ik+timewarp";

double VariantsPerSecond(Clock::time_point start) {
  return kVariantsPerRound / std::chrono::duration<double>(Clock::now() - start).count();
}

double Median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

double InProcessRound(const motion::Clip& clip, bool with_plausibility) {
  api::AugmentSpec spec;
  spec.sources.push_back({clip, {}});
  spec.method = kMethod;
  spec.variants_per_source = kVariantsPerRound;
  spec.with_plausibility = with_plausibility;
  const auto start = Clock::now();
  const auto flow =
      *pipeline::AugmentFlow::Create(spec, {{clip, *motion::JointRoles::Detect(*clip.skeleton())}});
  for (int i = 0; i < kVariantsPerRound; ++i) {
    if (!flow->Make(i, {}).ok()) std::abort();
  }
  return VariantsPerSecond(start);
}

double StreamedRound(v1::AugmentationService::Stub& stub, const motion::Clip& clip,
                     bool with_plausibility) {
  v1::AugmentRequest request;
  *request.add_sources()->mutable_clip() = convert::ToProto(clip);
  request.set_method(kMethod);
  request.set_variants_per_source(kVariantsPerRound);
  request.set_skip_plausibility(!with_plausibility);
  const auto start = Clock::now();
  grpc::ClientContext context;
  const auto reader = stub.Augment(&context, request);
  v1::AugmentResponse response;
  int received = 0;
  while (reader->Read(&response)) ++received;
  if (!reader->Finish().ok() || received != kVariantsPerRound) std::abort();
  return VariantsPerSecond(start);
}

Row Compare(v1::AugmentationService::Stub& stub, const motion::Clip& clip, bool with_plausibility) {
  std::vector<double> in_process, streamed, ratios;
  for (int round = 0; round < kRounds; ++round) {
    in_process.push_back(InProcessRound(clip, with_plausibility));
    streamed.push_back(StreamedRound(stub, clip, with_plausibility));
    ratios.push_back(streamed.back() / in_process.back());
  }
  return {.name = with_plausibility ? "grpc/augment_with_plausibility" : "grpc/augment",
          .value = Median(streamed),
          .unit = "variants/s",
          .peer = fmt::format("{:.0f} variants/s in process, one thread", Median(in_process)),
          .ratio = Median(ratios),
          .threads = 1};
}

}  // namespace

std::vector<Row> RunGrpcBenchmark() {
  server::StartLog("off").IgnoreError();
  const auto folder = std::filesystem::temp_directory_path() / "poise_grpc_bench";
  const auto engine =
      engine::Engine::Create({.data_dir = folder, .compute_threads = 1}, base::Telemetry::None());
  if (!engine.ok()) std::abort();
  server::ServerConfig config;
  config.listen = "127.0.0.1:0";
  const auto server = server::Server::Start(config, **engine, base::Telemetry::None());
  if (!server.ok()) std::abort();
  const auto stub = v1::AugmentationService::NewStub(
      grpc::CreateChannel((*server)->address(), grpc::InsecureChannelCredentials()));
  const motion::Clip clip = CapturedSizeClip(kFrames, kFrameRate);
  return {Compare(*stub, clip, false), Compare(*stub, clip, true)};
}

}  // namespace poise::bench
