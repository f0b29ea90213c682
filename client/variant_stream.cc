#include "client/variant_stream.h"

#include "client/transport_error.h"
#include "client/variant_call.h"
#include "proto/convert/augment_convert.h"

namespace poise::client {

VariantStream::VariantStream(std::unique_ptr<Call> call) : call_(std::move(call)) {}

VariantStream::~VariantStream() {
  if (call_->outcome_) return;
  call_->context_->TryCancel();
  call_->reader_->Finish();  // gRPC wants every call to be finished
}

StatusOr<std::optional<api::DeliveredVariant>> VariantStream::Next() {
  v1::AugmentResponse response;
  if (!call_->outcome_ && call_->reader_->Read(&response)) {
    POISE_ASSIGN_OR_RETURN(api::DeliveredVariant variant, convert::FromProto(response));
    return std::optional<api::DeliveredVariant>(std::move(variant));
  }
  if (!call_->outcome_) {
    call_->outcome_ = ExplainCall(call_->reader_->Finish(), call_->connection_.options());
  }
  POISE_RETURN_IF_ERROR(*call_->outcome_);
  return std::optional<api::DeliveredVariant>();
}

void VariantStream::Cancel() { call_->context_->TryCancel(); }

}  // namespace poise::client
