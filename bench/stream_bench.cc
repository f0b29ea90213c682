#include <algorithm>

#include "absl/time/clock.h"
#include "bench/benchmark.h"
#include "bench/predict_load.h"
#include "bench/predict_setup.h"
#include "core/motion/editing/cut.h"
#include "poise/v1/prediction_service.grpc.pb.h"
#include "proto/convert/predict_convert.h"
#include "server/log.h"

/// Forecasts while somebody moves: a stream of 60 frames a second with the shipped predictor, from
/// the moment a frame is handed to gRPC to the moment its forecast is here.
namespace poise::bench {
namespace {

constexpr double kStreamLimitMs = 1000.0 / 60;

// Sorted [ms].
std::vector<double> StreamLatencies(const Subject& subject, Service& service, absl::Duration time) {
  grpc::ClientContext context;
  const auto stub = v1::PredictionService::NewStub(OwnChannel(service.address()));
  const auto stream = stub->PredictStream(&context);
  v1::PredictStreamRequest setup;
  *setup.mutable_setup() =
      convert::ToProto(api::ForecastStreamSpec{.model = kPredictModel,
                                               .horizon_s = subject.horizon_s,
                                               .skeleton = subject.past.skeleton(),
                                               .frame_rate = subject.past.frame_rate()});
  if (!stream->Write(setup)) std::abort();
  const int past = subject.past.num_frames();
  std::vector<double> latencies;
  v1::PredictStreamResponse response;
  const absl::Time begin = absl::Now();
  for (int frame = 0; absl::Now() < begin + time; ++frame) {
    absl::SleepFor(begin + absl::Seconds(frame / subject.past.frame_rate()) - absl::Now());
    v1::PredictStreamRequest frames;
    const motion::Clip one = OrDie(motion::Cut(subject.past, frame % past, 1));
    *frames.mutable_frames() = convert::ToObservedFrames(one);
    const absl::Time sent = absl::Now();
    if (!stream->Write(frames)) std::abort();
    if (frame + 1 < past) continue;  // the model has not seen enough
    if (!stream->Read(&response)) std::abort();
    latencies.push_back(absl::ToDoubleMilliseconds(absl::Now() - sent));
  }
  stream->WritesDone();
  if (!stream->Finish().ok()) std::abort();
  std::sort(latencies.begin(), latencies.end());
  return latencies;
}

}  // namespace

std::vector<Row> RunStreamBenchmark() {
  server::StartLog("off").IgnoreError();
  const Subject subject = ReadSubject();
  Service service("stream", {});
  const absl::Duration time = Scaled(absl::Minutes(10));
  StreamLatencies(subject, service, time / 20);
  const double before = MemoryMb();
  const std::vector<double> latencies = StreamLatencies(subject, service, time);
  const double after = MemoryMb();
  const double p999 = Quantile(latencies, 0.999);
  return {{.name = "stream/frame_p99.9",
           .value = p999,
           .unit = "ms",
           .peer = fmt::format("limit {:.1f} ms; {} frames at {} Hz, p50 {:.2f} ms, longest {:.1f} "
                               "ms; memory {:.1f} MB, {:.1f} before",
                               kStreamLimitMs, latencies.size(), subject.past.frame_rate(),
                               Quantile(latencies, 0.5), latencies.back(), after, before),
           .ratio = kStreamLimitMs / p999}};
}

}  // namespace poise::bench
