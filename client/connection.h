#ifndef POISE_CLIENT_CONNECTION_H_
#define POISE_CLIENT_CONNECTION_H_

#include <memory>

#include "client/client_options.h"
#include "core/base/status.h"
#include "grpc/health/v1/health.grpc.pb.h"
#include "grpcpp/grpcpp.h"
#include "poise/v1/admin_service.grpc.pb.h"
#include "poise/v1/artifact_service.grpc.pb.h"
#include "poise/v1/augmentation_service.grpc.pb.h"
#include "poise/v1/data_service.grpc.pb.h"
#include "poise/v1/job_service.grpc.pb.h"
#include "poise/v1/model_service.grpc.pb.h"
#include "poise/v1/prediction_service.grpc.pb.h"
#include "poise/v1/push_service.grpc.pb.h"
#include "poise/v1/worker_service.grpc.pb.h"

namespace poise::client {

/// The channel to one server, with one client object per service.
/// Threads: all members may be called from any thread.
class Connection {
 public:
  explicit Connection(ClientOptions options);

  /// The metadata and the deadline of one call; at most `timeout` and the option of that name.
  std::unique_ptr<grpc::ClientContext> NewCall(
      absl::Duration timeout = absl::InfiniteDuration()) const;

  /// As ExplainCall; also tells a call that waited for its server in vain: kUnavailable NO_SERVER.
  Status Explain(const grpc::Status& status) const;

  /// Waits until the time is over, or until a connection that is broken stands again, and says
  /// which. (gRPC works on a connection only while somebody waits for it, so sleeping would not
  /// do.)
  bool Pause(absl::Duration time) const;

  const ClientOptions& options() const { return options_; }
  v1::AugmentationService::Stub& augmentation() const { return *augmentation_; }
  v1::PredictionService::Stub& prediction() const { return *prediction_; }
  v1::ArtifactService::Stub& artifact() const { return *artifact_; }
  v1::ModelService::Stub& model() const { return *model_; }
  v1::DataService::Stub& data() const { return *data_; }
  v1::JobService::Stub& job() const { return *job_; }
  v1::PushService::Stub& push() const { return *push_; }
  v1::WorkerService::Stub& worker() const { return *worker_; }
  v1::AdminService::Stub& admin() const { return *admin_; }
  grpc::health::v1::Health::Stub& health() const { return *health_; }

 private:
  const ClientOptions options_;
  std::shared_ptr<grpc::Channel> channel_;
  std::unique_ptr<v1::AugmentationService::Stub> augmentation_;
  std::unique_ptr<v1::PredictionService::Stub> prediction_;
  std::unique_ptr<v1::ArtifactService::Stub> artifact_;
  std::unique_ptr<v1::ModelService::Stub> model_;
  std::unique_ptr<v1::DataService::Stub> data_;
  std::unique_ptr<v1::JobService::Stub> job_;
  std::unique_ptr<v1::PushService::Stub> push_;
  std::unique_ptr<v1::WorkerService::Stub> worker_;
  std::unique_ptr<v1::AdminService::Stub> admin_;
  std::unique_ptr<grpc::health::v1::Health::Stub> health_;
};

}  // namespace poise::client

#endif  // POISE_CLIENT_CONNECTION_H_
