#ifndef POISE_SERVER_HANDLERS_UNARY_METHODS_H_
#define POISE_SERVER_HANDLERS_UNARY_METHODS_H_

#include <memory>
#include <utility>

#include "core/base/thread_pool.h"
#include "server/admission/admission.h"
#include "server/handlers/refusal.h"
#include "server/handlers/unary_call.h"
#include "server/handlers/wire.h"

namespace poise::server {

/// What gRPC hands to a unary method of raw bytes.
struct UnaryInput {
  grpc::CallbackServerContext* context;
  const grpc::ByteBuffer* request;
  grpc::ByteBuffer* response;
};

/// Parses the request and answers with what `work` makes of it. `Work` is a callable of
/// (const Request&, const Call&) that returns StatusOr of a message.
template <typename Request, typename Work>
class AnswerAtOnce : public UnaryCall {
 public:
  AnswerAtOnce(Setup setup, grpc::ByteBuffer request, Work work)
      : UnaryCall(std::move(setup)), request_(std::move(request)), work_(std::move(work)) {}

 private:
  Answer Try() override {
    POISE_ASSIGN_OR_RETURN(const Request request, Parse<Request>(std::move(request_)));
    POISE_ASSIGN_OR_RETURN(const auto response, work_(request, call()));
    return Serialize(response);
  }

  grpc::ByteBuffer request_;
  Work work_;
};

/// The way that the unary methods of all handlers go: admission, then a pool.
/// Threads: all members may be called from any thread.
class UnaryMethods {
 public:
  UnaryMethods(Admission& admission, base::ThreadPool& pool) : admission_(admission), pool_(pool) {}

  /// `CallType` is a UnaryCall made from (Setup, request bytes, arguments...).
  template <typename CallType, typename... Arguments>
  grpc::ServerUnaryReactor* Start(const UnaryInput& input, const MethodPolicy& policy,
                                  Arguments&&... arguments) {
    StatusOr<std::unique_ptr<Call>> call = admission_.Admit(*input.context, policy);
    if (!call.ok()) return new Refusal<grpc::ServerUnaryReactor>(call.status());
    return UnaryCall::Start(std::make_shared<CallType>(
        UnaryCall::Setup{input.context, *std::move(call), &pool_, input.response}, *input.request,
        std::forward<Arguments>(arguments)...));
  }

  template <typename Request, typename Work>
  grpc::ServerUnaryReactor* Answer(const UnaryInput& input, const MethodPolicy& policy, Work work) {
    return Start<AnswerAtOnce<Request, Work>>(input, policy, std::move(work));
  }

 private:
  Admission& admission_;
  base::ThreadPool& pool_;
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_UNARY_METHODS_H_
