#ifndef POISE_SERVER_SERVER_H_
#define POISE_SERVER_SERVER_H_

#include <grpcpp/server.h>

#include <memory>
#include <string>

#include "absl/time/time.h"
#include "core/base/status.h"
#include "core/base/telemetry.h"
#include "core/engine/engine.h"
#include "server/admission/admission.h"
#include "server/handlers/admin_handler.h"
#include "server/handlers/artifact_handler.h"
#include "server/handlers/augmentation_handler.h"
#include "server/handlers/data_handler.h"
#include "server/handlers/drain_state.h"
#include "server/handlers/job_handler.h"
#include "server/handlers/model_handler.h"
#include "server/handlers/operations_handler.h"
#include "server/handlers/prediction_handler.h"
#include "server/handlers/push_handler.h"
#include "server/handlers/unknown_method_handler.h"
#include "server/handlers/worker_handler.h"

namespace poise::server {

struct ServerConfig {
  std::string listen = "127.0.0.1:50051";  ///< port 0: any free one
  AdmissionConfig admission;
  MethodPolicies methods;
  int max_message_bytes = 64 << 20;         ///< [bytes] larger files go through ArtifactService
  int64_t max_transport_bytes = 1LL << 30;  ///< [bytes] what gRPC's buffers may take together
  /// [> 0] Threads that wait for the job store: so many writes share one sync of the disk.
  int store_threads = 32;
  absl::Duration snapshot_interval = absl::Seconds(15);  ///< [> 0] in watches of silent jobs
};

/// The services on one port, with health and reflection.
class Server {
 public:
  /// `engine` and `telemetry` must outlive the server.
  /// Errors: kFailedPrecondition CANNOT_LISTEN with the address.
  static StatusOr<std::unique_ptr<Server>> Start(const ServerConfig& config, engine::Engine& engine,
                                                 base::Telemetry& telemetry);
  ~Server();

  /// Where it listens, with the port that was chosen.
  const std::string& address() const { return address_; }
  int calls() const { return admission_.calls(); }

  /// Tells health checks that no new work should come, and workers that wait for a job to ask
  /// elsewhere; all other calls are served as before.
  void AnnounceShutdown();
  /// Closes the port, sends away who watches or waits, lets calls finish until the deadline, then
  /// cancels them. Returns when all are done.
  void Shutdown(absl::Time deadline);

 private:
  Server(const ServerConfig& config, engine::Engine& engine, base::Telemetry& telemetry);
  Status Listen(const ServerConfig& config, base::Telemetry& telemetry);

  engine::JobManager& job_manager_;
  DrainState drain_;
  Admission admission_;
  base::ThreadPool store_calls_;
  AugmentationHandler augmentation_;
  PredictionHandler prediction_;
  PushHandler push_;
  ArtifactHandler artifacts_;
  ModelHandler models_;
  DataHandler data_;
  JobHandler jobs_;
  OperationsHandler operations_;
  WorkerHandler workers_;
  AdminHandler admin_;
  UnknownMethodHandler unknown_method_;
  std::unique_ptr<grpc::Server> server_;
  std::string address_;
};

}  // namespace poise::server

#endif  // POISE_SERVER_SERVER_H_
