#ifndef POISE_SERVER_HANDLERS_REFUSAL_H_
#define POISE_SERVER_HANDLERS_REFUSAL_H_

#include "core/base/status.h"
#include "proto/convert/status_convert.h"

namespace poise::server {

/// The reactor of a call that ends with an error before it began. `Reactor` is one of gRPC's.
template <typename Reactor>
class Refusal : public Reactor {
 public:
  explicit Refusal(const Status& status) { this->Finish(convert::ToGrpc(status)); }
  void OnDone() override { delete this; }
};

}  // namespace poise::server

#endif  // POISE_SERVER_HANDLERS_REFUSAL_H_
