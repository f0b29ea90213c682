#include "server/handlers/augmentation_handler.h"

#include <algorithm>
#include <utility>

#include "proto/convert/augment_convert.h"
#include "server/handlers/message_stream.h"
#include "server/handlers/refusal.h"
#include "server/handlers/wire.h"

namespace poise::server {
namespace {

// Enough that one client can keep every compute thread busy while messages are written.
int Window(const base::ThreadPool& pool) { return std::min(pool.size() + 2, 16); }

// To send a variant takes less than a quarter of the time in which it is made.
int NumWriters(const base::ThreadPool& compute) { return (compute.size() + 3) / 4; }

class AugmentStream : public MessageStream {
 public:
  AugmentStream(Setup setup, grpc::ByteBuffer request, engine::Engine& engine,
                base::Counter& variants)
      : MessageStream(std::move(setup)),
        request_(std::move(request)),
        engine_(engine),
        variants_(variants) {}

 private:
  StatusOr<int64_t> Prepare(const base::RunContext& context) override {
    POISE_ASSIGN_OR_RETURN(const v1::AugmentRequest request,
                           Parse<v1::AugmentRequest>(std::move(request_)));
    POISE_ASSIGN_OR_RETURN(api::AugmentSpec spec, convert::FromProto(request));
    POISE_ASSIGN_OR_RETURN(run_, engine_.PrepareAugment(std::move(spec), context));
    return run_->num_variants();
  }

  StatusOr<grpc::ByteBuffer> Make(int64_t ordinal, const base::RunContext& context) override {
    POISE_ASSIGN_OR_RETURN(const api::DeliveredVariant variant, run_->Make(ordinal, context));
    variants_.Increment();
    return Serialize(convert::ToProto(variant));
  }

  grpc::ByteBuffer request_;
  engine::Engine& engine_;
  base::Counter& variants_;
  std::unique_ptr<engine::AugmentRun> run_;
};

}  // namespace

AugmentationHandler::AugmentationHandler(engine::Engine& engine, Admission& admission,
                                         const MethodPolicy& policy, base::Telemetry& telemetry)
    : engine_(engine),
      admission_(admission),
      policy_(policy),
      writers_(NumWriters(engine.compute())),
      variants_(telemetry.counter("poise_augment_variants_total", "Variants made", {})) {}

grpc::ServerWriteReactor<grpc::ByteBuffer>* AugmentationHandler::Augment(
    grpc::CallbackServerContext* context, const grpc::ByteBuffer* request) {
  StatusOr<std::unique_ptr<Call>> call = admission_.Admit(*context, policy_);
  if (!call.ok()) return new Refusal<grpc::ServerWriteReactor<grpc::ByteBuffer>>(call.status());
  return MessageStream::Start(std::make_shared<AugmentStream>(
      MessageStream::Setup{context, *std::move(call), &engine_.compute(), &writers_,
                           Window(engine_.compute())},
      *request, engine_, variants_));
}

}  // namespace poise::server
