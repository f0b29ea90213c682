#include "server/admission/admission.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <random>

#include "absl/time/clock.h"
#include "core/base/identifier.h"

namespace poise::server {
namespace {

constexpr char kRequestIdKey[] = "x-request-id";
constexpr char kTenantKey[] = "x-poise-tenant";
constexpr char kTraceKey[] = "traceparent";
constexpr size_t kMaxRequestId = 128;
constexpr size_t kMaxTenant = 63;
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

// Safe in filters, metrics and log lines.
StatusOr<std::string> TenantOf(const grpc::CallbackServerContext& context) {
  const std::string tenant = Metadata(context, kTenantKey);
  if (tenant.empty()) return "default";
  const bool usable =
      tenant.size() <= kMaxTenant && std::all_of(tenant.begin(), tenant.end(), [](unsigned char c) {
        return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.';
      });
  if (usable) return tenant;
  return base::InvalidArgument("BAD_TENANT", kTenantKey,
                               fmt::format("expected 1 to {} letters, digits, '-', '_' or '.' in "
                                           "the metadata {}",
                                           kMaxTenant, kTenantKey));
}

// "00-<32 hex digits>-<16 hex digits>-<2 hex digits>" (W3C Trace Context): the 32.
std::string TraceIdOf(const grpc::CallbackServerContext& context) {
  constexpr size_t kLength = 55, kIdBegin = 3, kIdLength = 32;
  const std::string trace = Metadata(context, kTraceKey);
  if (trace.size() >= kLength && trace[2] == '-' && trace[kIdBegin + kIdLength] == '-') {
    std::string id = trace.substr(kIdBegin, kIdLength);
    const bool hex = id.find_first_not_of("0123456789abcdef") == std::string::npos;
    if (hex && id.find_first_not_of('0') != std::string::npos) return id;
  }
  return base::RandomHex(kIdLength / 2);
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

Call::Call(Admission& admission, CallOrigin origin, Place place, absl::Time deadline)
    : admission_(admission), origin_(std::move(origin)), place_(place) {
  run_.deadline = deadline;
}

Call::~Call() { admission_.GivePlace(origin_.peer, place_); }

Admission::Admission(AdmissionConfig config, base::Telemetry& telemetry)
    : config_(std::move(config)),
      calls_gauge_(telemetry.gauge("poise_calls_at_work", "Admitted calls that are not done", {})),
      waiting_gauge_(
          telemetry.gauge("poise_calls_waiting", "Admitted calls that wait for something", {})),
      refused_(
          telemetry.counter("poise_calls_refused_total", "Calls refused before any work", {})) {}

StatusOr<std::unique_ptr<Call>> Admission::Admit(grpc::CallbackServerContext& context,
                                                 const MethodPolicy& policy) {
  CallOrigin origin{.peer = WithoutPort(context.peer()),
                    .request_id = Metadata(context, kRequestIdKey),
                    .tenant = "default",
                    .trace_id = TraceIdOf(context)};
  if (!IsUsableRequestId(origin.request_id)) origin.request_id = NewRequestId();
  Status status = CheckToken(context);
  if (status.ok()) {
    StatusOr<std::string> tenant = TenantOf(context);
    status = tenant.ok() ? TakePlace(origin.peer, policy.place) : tenant.status();
    if (tenant.ok()) origin.tenant = *std::move(tenant);
  }
  if (!status.ok()) {
    refused_.Increment();
    // After initial metadata a client's gRPC does not make the call again by itself.
    context.AddTrailingMetadata(kRequestIdKey, origin.request_id);
    return status;
  }
  context.AddInitialMetadata(kRequestIdKey, origin.request_id);
  return std::unique_ptr<Call>(
      new Call(*this, std::move(origin), policy.place, Deadline(context, policy)));
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

Status Admission::TakePlace(const std::string& peer, Place place) {
  std::lock_guard lock(mutex_);
  if (closed_) {
    return base::WithRetryDelay(
        base::MakeError(absl::StatusCode::kUnavailable, "SHUTTING_DOWN", "",
                        "this server is shutting down: try again, at another one"),
        kRetryDelay);
  }
  return place == Place::kWork ? TakeWork(peer) : TakeWaiting(place);
}

Status Admission::TakeWork(const std::string& peer) {
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

Status Admission::TakeWaiting(Place place) {
  const double share = place == Place::kWatch ? 1.0 - config_.worker_share : 1.0;
  if (waiting_ >= config_.max_waiting_calls * share) {
    return base::WithRetryDelay(
        base::ResourceExhausted("TOO_MANY_WAITING_CALLS", "",
                                fmt::format("{} calls wait, at most {}: try again later", waiting_,
                                            static_cast<int>(config_.max_waiting_calls * share))),
        kRetryDelay);
  }
  ++waiting_;
  waiting_gauge_.Set(waiting_);
  return absl::OkStatus();
}

void Admission::GivePlace(const std::string& peer, Place place) {
  std::lock_guard lock(mutex_);
  if (place == Place::kWork) {
    --calls_;
    calls_gauge_.Set(calls_);
    const auto of_peer = calls_of_peer_.find(peer);
    if (--of_peer->second == 0) calls_of_peer_.erase(of_peer);
  } else {
    --waiting_;
    waiting_gauge_.Set(waiting_);
  }
  if (calls_ + waiting_ == 0) idle_.notify_all();
}

void Admission::WaitUntilIdle() {
  std::unique_lock lock(mutex_);
  idle_.wait(lock, [this] { return calls_ + waiting_ == 0; });
}

void Admission::Close() {
  std::lock_guard lock(mutex_);
  closed_ = true;
}

int Admission::calls() const {
  std::lock_guard lock(mutex_);
  return calls_ + waiting_;
}

}  // namespace poise::server
