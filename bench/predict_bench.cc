#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <thread>

#include "absl/time/clock.h"
#include "bench/benchmark.h"
#include "bench/predict_load.h"
#include "bench/predict_setup.h"
#include "poise/v1/prediction_service.grpc.pb.h"
#include "proto/convert/predict_convert.h"
#include "server/log.h"

/// What serving the shipped predictor costs: one call through gRPC beside the bare forward pass; 32
/// clients with and without batches, beside the best rate in this process; how long requests wait
/// for their batch; ten times as many clients as fit; new versions under traffic. Clients share the
/// machine with the server. POISE_BENCH_SCALE (1) multiplies the time of each part.
namespace poise::bench {
namespace {

using prediction::Observation;

constexpr int kClients = 32;
constexpr int kOverload = 10;
constexpr double kGrpcLimit = 1.15;
constexpr double kGrpcSlackMs = 0.3;  // where the bare pass takes less than 2 ms

double Median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}

// Milliseconds of one forward pass, and of one call.
double ForwardMs(const Subject& subject) {
  const Observation seen{subject.past, {}};
  const absl::Time begin = absl::Now();
  OrDie(subject.predictor->Predict({&seen, 1}, kPredictFrames, {}));
  return absl::ToDoubleMilliseconds(absl::Now() - begin);
}

double CallMs(v1::PredictionService::Stub& stub, const v1::PredictRequest& request) {
  const absl::Time begin = absl::Now();
  grpc::ClientContext context;
  v1::PredictResponse response;
  const grpc::Status status = stub.Predict(&context, request, &response);
  if (!status.ok()) std::abort();
  return absl::ToDoubleMilliseconds(absl::Now() - begin);
}

Row OneCall(const Subject& subject, Service& service) {
  constexpr int kCallsOfRound = 50;
  const auto stub = v1::PredictionService::NewStub(OwnChannel(service.address()));
  const v1::PredictRequest request = convert::ToProto(api::PredictQuery{
      .source = {subject.past, {}}, .model = kPredictModel, .horizon_s = subject.horizon_s});
  for (int i = 0; i < kCallsOfRound; ++i) CallMs(*stub, request), ForwardMs(subject);
  std::vector<double> bare, calls;
  const absl::Time end = absl::Now() + Scaled(absl::Seconds(10));
  while (absl::Now() < end || bare.empty()) {  // in turns, so that a busy machine slows both
    for (int i = 0; i < kCallsOfRound; ++i) bare.push_back(ForwardMs(subject));
    for (int i = 0; i < kCallsOfRound; ++i) calls.push_back(CallMs(*stub, request));
  }
  const double forward = Median(bare), call = Median(calls);
  const double limit = std::max(kGrpcLimit * forward, forward < 2 ? forward + kGrpcSlackMs : 0);
  return {
      .name = "predict/one_call_p50",
      .value = 1000 * call,
      .unit = "us",
      .peer = fmt::format("bare forward {:.0f} us: {:.2f} times, {:+.0f} us; limit {:.0f} us",
                          1000 * forward, call / forward, 1000 * (call - forward), 1000 * limit),
      .ratio = limit / call};
}

double ProcessCpuSeconds() {
  timespec used;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

// Processor time of an answer [us].
struct AnswerCost {
  double all = 0;  // clients and server
  double server = 0;
};

AnswerCost CostOf(const LoadResult& load, double process_cpu_s) {
  const double answers = std::max<double>(load.answered, 1);
  return {.all = 1e6 * process_cpu_s / answers,
          .server = 1e6 * (process_cpu_s - load.client_cpu_s) / answers};
}

// Motions a second of all cores, in batches of a size, without gRPC.
double InProcessRate(const Subject& subject, int batch, absl::Duration time) {
  std::atomic<int64_t> motions = 0;
  std::vector<std::thread> threads;
  const absl::Time begin = absl::Now();
  for (int i = 0; i < base::AvailableCpus(); ++i) {
    threads.emplace_back([&] {
      const std::vector<Observation> seen(batch, Observation{subject.past, {}});
      while (absl::Now() < begin + time) {
        OrDie(subject.predictor->Predict(seen, kPredictFrames, {}));
        motions += batch;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  return static_cast<double>(motions) / absl::ToDoubleSeconds(absl::Now() - begin);
}

struct Throughput {
  std::vector<Row> rows;
  double batched = 0;  // [answers/s]
};

Throughput ManyClients(const Subject& subject, Service& single, Service& batching) {
  constexpr int kSizes[] = {1, 4, 8, 16, 32};
  constexpr int kRounds = 5;
  const absl::Duration round = Scaled(absl::Seconds(4));
  std::vector<std::vector<double>> in_process(std::size(kSizes));
  std::vector<double> unbatched, batched, gains, shares, waits, floor_us, server_us, alone_us;
  for (int i = 0; i < kRounds; ++i) {
    double best = 0;
    for (size_t size = 0; size < std::size(kSizes); ++size) {
      in_process[size].push_back(InProcessRate(subject, kSizes[size], round / 4));
      best = std::max(best, in_process[size].back());
    }
    AnswerCost cost;
    const auto load = [&](Service& service, const char* model) {
      const double used_before = ProcessCpuSeconds();
      const LoadResult result =
          RunLoad(service.address(), model, subject.past, subject.horizon_s, kClients, round);
      cost = CostOf(result, ProcessCpuSeconds() - used_before);
      if (result.failed + result.refused > 0) {
        fmt::print(stderr, "predict: {} calls failed, {} were refused: {}\n", result.failed,
                   result.refused, result.first_failure);
      }
      return result.rate();
    };
    load(batching, "zero-velocity");
    floor_us.push_back(cost.all);
    unbatched.push_back(load(single, kPredictModel));
    batching.telemetry.TakeSorted();
    batched.push_back(load(batching, kPredictModel));
    server_us.push_back(cost.server);
    alone_us.push_back(1e6 * base::AvailableCpus() / best);
    const std::vector<double> of_round = batching.telemetry.TakeSorted();
    waits.insert(waits.end(), of_round.begin(), of_round.end());
    gains.push_back(batched.back() / unbatched.back());
    shares.push_back(batched.back() / best);
  }
  std::sort(waits.begin(), waits.end());
  std::string sizes;
  double best = 0;
  for (size_t size = 0; size < std::size(kSizes); ++size) {
    const double rate = Median(in_process[size]);
    best = std::max(best, rate);
    sizes += fmt::format("{}{}: {:.0f}", size == 0 ? "" : ", ", kSizes[size], rate);
  }
  const double ceiling = absl::ToDoubleMilliseconds(serving::ServingConfig().max_added_delay);
  Throughput result{.rows = {}, .batched = Median(batched)};
  result.rows.push_back(
      {.name = "predict/32_clients_batched",
       .value = result.batched,
       .unit = "answers/s",
       .peer = fmt::format("{:.0f} answers/s without batches; wanted 1.3 times", Median(unbatched)),
       .ratio = Median(gains),
       .threads = kClients});
  result.rows.push_back(
      {.name = "predict/32_clients_in_process",
       .value = result.batched,
       .unit = "answers/s",
       .peer = fmt::format("best in process {:.0f}/s; wanted 0.85 times; motions/s "
                           "by size of batch {}",
                           best, sizes),
       .ratio = Median(shares),
       .threads = kClients});
  result.rows.push_back(
      {.name = "predict/server_cpu_per_answer",
       .value = Median(server_us),
       .unit = "us",
       .peer = fmt::format("best in process {:.0f} us a motion; a call that holds the last pose "
                           "costs {:.0f} us, its client included",
                           Median(alone_us), Median(floor_us)),
       .ratio = Median(alone_us) / Median(server_us),
       .threads = kClients});
  const double p99 = Quantile(waits, 0.99);
  result.rows.push_back({.name = "predict/added_wait_p99",
                         .value = 1000 * p99,
                         .unit = "us",
                         .peer = fmt::format("ceiling {:.0f} us; p50 {:.0f} us", 1000 * ceiling,
                                             1000 * Quantile(waits, 0.5)),
                         .ratio = ceiling / p99,
                         .threads = kClients});
  return result;
}

std::vector<Row> Overload(const Subject& subject, Service& service, double capacity) {
  const absl::Duration time = Scaled(absl::Seconds(60));
  // What the first sixth brings into memory stays.
  RunLoad(service.address(), kPredictModel, subject.past, subject.horizon_s, kOverload * kClients,
          time / 6);
  service.telemetry.TakeSorted();
  const double before = MemoryMb();
  const LoadResult load = RunLoad(service.address(), kPredictModel, subject.past, subject.horizon_s,
                                  kOverload * kClients, time);
  service.telemetry.TakeSorted();
  const double after = MemoryMb();
  return {
      {.name = "predict/overload_goodput",
       .value = load.rate(),
       .unit = "answers/s",
       .peer = fmt::format("{:.0f}/s of {} clients: wanted 0.9 times; {} clients, {} refused in "
                           "{:.1f} ms (p50), {} failed {}",
                           capacity, kClients, kOverload * kClients, load.refused,
                           Quantile(load.refusals_ms, 0.5), load.failed, load.first_failure),
       .ratio = load.rate() / capacity,
       .threads = kOverload * kClients},
      {.name = "predict/overload_memory",
       .value = after,
       .unit = "MB",
       .peer = fmt::format("{:.1f} MB before", before),
       .ratio = before / after,
       .threads = kOverload * kClients}};
}

Row NewVersions(const Subject& subject, Service& service) {
  constexpr char kName[] = "loaded-under-traffic";
  constexpr int kFewClients = 8;
  artifacts::ModelArtifact model = subject.model;
  const auto add = [&](uint64_t seed) {
    model.card.seed = seed;
    const auto stored = OrDie(service.engine->artifacts().Put(artifacts::PackModel(model)));
    OrDie(service.engine->models().Import(kName, stored.name));
  };
  add(0);
  const absl::Duration time = Scaled(absl::Seconds(10));
  const auto ask = [&] {
    return RunLoad(service.address(), kName, subject.past, subject.horizon_s, kFewClients, time);
  };
  const LoadResult quiet = ask();
  std::atomic<bool> done = false;
  int versions = 1;
  std::thread loader([&] {
    while (!done) {
      add(versions++);
      absl::SleepFor(absl::Milliseconds(500));
    }
  });
  const LoadResult busy = ask();
  done = true;
  loader.join();
  return {.name = "predict/new_versions_p99",
          .value = Quantile(busy.latencies_ms, 0.99),
          .unit = "ms",
          .peer = fmt::format("{:.1f} ms without; {} versions, {} answers, {} errors {}",
                              Quantile(quiet.latencies_ms, 0.99), versions, busy.answered,
                              busy.failed + busy.refused, busy.first_failure),
          .ratio = Quantile(quiet.latencies_ms, 0.99) / Quantile(busy.latencies_ms, 0.99),
          .threads = kFewClients};
}

}  // namespace

std::vector<Row> RunPredictBenchmark() {
  server::StartLog("off").IgnoreError();
  const Subject subject = ReadSubject();
  Service single("single", {.max_batch = 1}), batching("batching", {});
  std::vector<Row> rows = {OneCall(subject, batching)};
  Throughput many = ManyClients(subject, single, batching);
  std::move(many.rows.begin(), many.rows.end(), std::back_inserter(rows));
  for (Row& row : Overload(subject, batching, many.batched)) rows.push_back(std::move(row));
  rows.push_back(NewVersions(subject, batching));
  return rows;
}

}  // namespace poise::bench
