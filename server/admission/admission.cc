#include "server/admission/admission.h"

#include <fmt/format.h>

#include <algorithm>
#include <random>

#include "absl/time/clock.h"

namespace poise::server {
namespace {

constexpr char kRequestIdKey[] = "x-request-id";
constexpr size_t kMaxRequestId = 128;
constexpr absl::Duration kRetryDelay = absl::Seconds(1);

std::string Metadata(const grpc::CallbackServerContext& context, const char* key) {
  const auto& metadata = context.client_metadata();
  const auto found = metadata.find(key);
  return found == metadata.end() ? std::string()
                                 : std::string(found->second.data(), found->second.size());
}

// Goes back in a header and into the log, so only visible ASCII passes.
bool IsUsableRequestId(const std::string& id) {
  return !id.empty() && id.size() <= kMaxRequestId &&
         std::all_of(id.begin(), id.end(), [](char c) { return c > ' ' && c < 127; });
}

std::string NewRequestId() {
  static thread_local std::mt19937_64 engine{(uint64_t{std::random_device()()} << 32) ^
                                             std::random_device()()};
  return fmt::format("{:016x}", engine());
}

// "ipv4:10.0.0.1:4242" -> "ipv4:10.0.0.1": a client is an address, whatever port it uses.
std::string WithoutPort(const std::string& peer) {
  const size_t colon = peer.rfind(':');
  return colon == std::string::npos || peer.rfind("unix", 0) == 0 ? peer : peer.substr(0, colon);
}

absl::Time Deadline(const grpc::CallbackServerContext& context, const MethodPolicy& policy) {
  const absl::Time now = absl::Now();
  const std::chrono::system_clock::time_point asked = context.deadline();
  if (asked == std::chrono::system_clock::time_point::max()) return now + policy.default_deadline;
  return std::min(absl::FromChrono(asked), now + policy.max_deadline);
}

// Takes the same time wherever the texts differ.
bool SameSecret(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned char difference = 0;
  for (size_t i = 0; i < a.size(); ++i) difference |= a[i] ^ b[i];
  return difference == 0;
}

}  // namespace

Call::Call(Admission& admission, std::string peer, std::string request_id, absl::Time deadline)
    : admission_(admission), peer_(std::move(peer)), request_id_(std::move(request_id)) {
  run_.deadline = deadline;
}

Call::~Call() { admission_.GivePlace(peer_); }

Admission::Admission(AdmissionConfig config, base::Telemetry& telemetry)
    : config_(std::move(config)),
      calls_gauge_(telemetry.gauge("poise_calls_at_work", "Admitted calls that are not done", {})),
      refused_(
          telemetry.counter("poise_calls_refused_total", "Calls refused before any work", {})) {}

StatusOr<std::unique_ptr<Call>> Admission::Admit(grpc::CallbackServerContext& context,
                                                 const MethodPolicy& policy) {
  std::string request_id = Metadata(context, kRequestIdKey);
  if (!IsUsableRequestId(request_id)) request_id = NewRequestId();
  context.AddInitialMetadata(kRequestIdKey, request_id);
  const std::string peer = WithoutPort(context.peer());
  Status status = CheckToken(context);
  if (status.ok()) status = TakePlace(peer);
  if (!status.ok()) {
    refused_.Increment();
    return status;
  }
  return std::unique_ptr<Call>(
      new Call(*this, peer, std::move(request_id), Deadline(context, policy)));
}

Status Admission::CheckToken(const grpc::CallbackServerContext& context) const {
  if (config_.token.empty()) return absl::OkStatus();
  const std::string authorization = Metadata(context, "authorization");
  if (authorization.empty()) {
    return base::MakeError(absl::StatusCode::kUnauthenticated, "MISSING_TOKEN", "",
                           "this server wants a token: set POISE_TOKEN, or send the metadata "
                           "'authorization: Bearer TOKEN'");
  }
  if (!SameSecret(authorization, "Bearer " + config_.token)) {
    return base::MakeError(absl::StatusCode::kUnauthenticated, "WRONG_TOKEN", "",
                           "the token of this call is not the server's");
  }
  return absl::OkStatus();
}

Status Admission::TakePlace(const std::string& peer) {
  std::lock_guard lock(mutex_);
  if (closed_) {
    return base::WithRetryDelay(
        base::MakeError(absl::StatusCode::kUnavailable, "SHUTTING_DOWN", "",
                        "this server is shutting down: try again, at another one"),
        kRetryDelay);
  }
  if (calls_ >= config_.max_calls) {
    return base::WithRetryDelay(
        base::ResourceExhausted("TOO_MANY_CALLS", "",
                                fmt::format("{} calls are at work, at most {}: try again later",
                                            calls_, config_.max_calls)),
        kRetryDelay);
  }
  const auto of_peer = calls_of_peer_.find(peer);
  if (of_peer != calls_of_peer_.end() && of_peer->second >= config_.max_calls_per_peer) {
    return base::WithRetryDelay(
        base::ResourceExhausted("TOO_MANY_CALLS_OF_PEER", "",
                                fmt::format("{} calls of this client are at work, at most {}: try "
                                            "again when one is done",
                                            of_peer->second, config_.max_calls_per_peer)),
        kRetryDelay);
  }
  ++calls_;
  ++calls_of_peer_[peer];
  calls_gauge_.Set(calls_);
  return absl::OkStatus();
}

void Admission::GivePlace(const std::string& peer) {
  std::lock_guard lock(mutex_);
  --calls_;
  calls_gauge_.Set(calls_);
  const auto of_peer = calls_of_peer_.find(peer);
  if (--of_peer->second == 0) calls_of_peer_.erase(of_peer);
  if (calls_ == 0) idle_.notify_all();
}

void Admission::WaitUntilIdle() {
  std::unique_lock lock(mutex_);
  idle_.wait(lock, [this] { return calls_ == 0; });
}

void Admission::Close() {
  std::lock_guard lock(mutex_);
  closed_ = true;
}

int Admission::calls() const {
  std::lock_guard lock(mutex_);
  return calls_;
}

}  // namespace poise::server
