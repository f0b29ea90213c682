#include "bench/predict_load.h"

#include <grpcpp/create_channel.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>

#include "absl/time/clock.h"
#include "poise/v1/prediction_service.grpc.pb.h"
#include "proto/convert/predict_convert.h"
#include "proto/convert/status_convert.h"

namespace poise::bench {
namespace {

double ThreadCpuSeconds() {
  timespec used;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
  return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

// One client until the end.
LoadResult Ask(const std::string& address, const v1::PredictRequest& request, absl::Time end) {
  const auto stub = v1::PredictionService::NewStub(OwnChannel(address));
  LoadResult result;
  const double used_before = ThreadCpuSeconds();
  for (absl::Time begin = absl::Now(); begin < end; begin = absl::Now()) {
    grpc::ClientContext context;
    v1::PredictResponse response;
    const grpc::Status status = stub->Predict(&context, request, &response);
    const double milliseconds = absl::ToDoubleMilliseconds(absl::Now() - begin);
    if (status.ok()) {
      ++result.answered;
      result.latencies_ms.push_back(milliseconds);
      continue;
    }
    const Status error = convert::FromGrpc(status);
    const auto delay = base::RetryDelay(error);
    if (absl::IsResourceExhausted(error) && delay) {
      ++result.refused;
      result.refusals_ms.push_back(milliseconds);
      absl::SleepFor(std::min(*delay, std::max(end - absl::Now(), absl::ZeroDuration())));
    } else {
      if (++result.failed == 1) result.first_failure = base::Message(error);
    }
  }
  result.client_cpu_s = ThreadCpuSeconds() - used_before;
  return result;
}

void Add(LoadResult one, LoadResult& all) {
  all.client_cpu_s += one.client_cpu_s;
  all.answered += one.answered;
  all.refused += one.refused;
  all.failed += one.failed;
  if (all.first_failure.empty()) all.first_failure = one.first_failure;
  all.latencies_ms.insert(all.latencies_ms.end(), one.latencies_ms.begin(), one.latencies_ms.end());
  all.refusals_ms.insert(all.refusals_ms.end(), one.refusals_ms.begin(), one.refusals_ms.end());
}

}  // namespace

double Quantile(const std::vector<double>& sorted, double share) {
  if (sorted.empty()) return 0;
  return sorted[std::min(sorted.size() - 1, static_cast<size_t>(share * sorted.size()))];
}

std::shared_ptr<grpc::Channel> OwnChannel(const std::string& address) {
  static std::atomic<int> number = 0;
  grpc::ChannelArguments arguments;
  arguments.SetInt("poise.bench.channel", ++number);
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  return grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments);
}

LoadResult RunLoad(const std::string& address, const std::string& model, const motion::Clip& past,
                   double horizon_s, int clients, absl::Duration duration) {
  const v1::PredictRequest request = convert::ToProto(
      api::PredictQuery{.source = {past, {}}, .model = model, .horizon_s = horizon_s});
  LoadResult all;
  std::mutex mutex;
  std::vector<std::thread> threads;
  const absl::Time begin = absl::Now();
  for (int i = 0; i < clients; ++i) {
    threads.emplace_back([&] {
      LoadResult one = Ask(address, request, begin + duration);
      std::lock_guard lock(mutex);
      Add(std::move(one), all);
    });
  }
  for (std::thread& thread : threads) thread.join();
  all.seconds = absl::ToDoubleSeconds(absl::Now() - begin);
  std::sort(all.latencies_ms.begin(), all.latencies_ms.end());
  std::sort(all.refusals_ms.begin(), all.refusals_ms.end());
  return all;
}

}  // namespace poise::bench
