#ifndef POISE_CLIENT_CLIENT_H_
#define POISE_CLIENT_CLIENT_H_

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "client/client_options.h"
#include "client/job_handle.h"
#include "client/job_watch.h"
#include "client/push_stream.h"
#include "client/stored_artifact.h"
#include "client/variant_stream.h"
#include "core/api/augment_spec.h"
#include "core/api/data_set.h"
#include "core/api/job.h"
#include "core/api/model_card.h"
#include "core/api/predict_query.h"
#include "core/api/push_spec.h"
#include "core/base/status.h"

namespace poise::client {

class Connection;

/// What the server's doctor found about its store of jobs.
struct Finding {
  enum class Severity { kOk, kWarning, kFault };
  Severity severity = Severity::kFault;
  std::string check;  ///< "integrity", "counts", ...
  std::string message;
};

/// A copy of the store of jobs, on the server's machine.
struct StoreBackup {
  std::string path;
  int64_t size_bytes = 0;
};

enum class ServerHealth { kServing, kNotServing };

/// A Poise server, as typed calls:
///
///   auto client = Client::Connect();
///   auto stream = (*client)->Augment({.sources = {{clip}}, .method = "ik", .seed = 1});
///   while (true) {
///     auto variant = (*stream)->Next();
///     if (!variant.ok() || !variant->has_value()) break;
///     ...
///   }
///
/// Errors of every call: the server's, and those of transport_error.h.
/// Threads: all members may be called from any thread.
class Client {
 public:
  /// Errors: kUnavailable NO_SERVER with how to start one; see transport_error.h.
  static StatusOr<std::unique_ptr<Client>> Connect(
      const ClientOptions& options = ClientOptions::FromEnvironment());
  ~Client();

  /// Starts the stream of variants. Sources too large for one message are uploaded first
  /// (ClientOptions::inline_bytes); arrays travel in single precision, or as BVH
  /// when uploaded (then the joints come back in depth-first order).
  /// Errors: those of AugmentSpec::Validate here, the others from the stream.
  StatusOr<std::unique_ptr<VariantStream>> Augment(api::AugmentSpec spec);

  /// What comes next. Of arrays only the last kMaxPast are sent.
  /// Errors: those of PredictQuery::Validate here, the others from the server.
  StatusOr<api::Forecast> Predict(api::PredictQuery query);
  static constexpr absl::Duration kMaxPast = absl::Seconds(30);  ///< more than any model looks at

  /// Starts the forecast of a scene. Errors: those of PushSpec::Validate here, the others from the
  /// stream.
  StatusOr<std::unique_ptr<PushStream>> ForecastPush(const api::PushSpec& spec);

  /// Stores a file on the server; the same bytes get the same name. Goes on by itself when the
  /// connection breaks. Errors: kInternal CORRUPTED when the server stored something else; those of
  /// artifact_transfer.h.
  StatusOr<StoredArtifact> Upload(std::string_view data);
  StatusOr<StoredArtifact> UploadFile(const std::filesystem::path& path);

  /// The bytes of an artifact from byte `offset` on. Errors: kNotFound; kInternal CORRUPTED when a
  /// whole file does not hash to its name.
  StatusOr<std::string> Download(const std::string& name, int64_t offset = 0);
  /// Errors: those of DownloadToFile in artifact_transfer.h.
  Status DownloadFile(const std::string& name, const std::filesystem::path& path);

  /// Long work; JobService in job_service.proto says what the server does, and its errors. An id is
  /// what follows "jobs/". A request without an id of its own gets one, so that a call whose answer
  /// was lost can be repeated: a server that is gone for less than ClientOptions::outage is waited
  /// for.
  StatusOr<api::Job> CreateJob(api::CreateJob request);
  StatusOr<api::Job> GetJob(const std::string& id);
  /// `page_size` 0: the server's choice. Attempts are left out.
  StatusOr<api::JobPage> ListJobs(const api::JobFilter& filter = {}, int page_size = 0,
                                  const std::string& page_token = "");
  StatusOr<api::Job> CancelJob(const std::string& id);
  Status DeleteJob(const std::string& id);
  StatusOr<api::Job> RetryJob(const std::string& id, std::string request_id = "");
  std::unique_ptr<JobWatch> WatchJob(const std::string& id, const WatchOptions& options = {});
  /// All that can be done with one job.
  JobHandle Handle(const std::string& id);

  /// Trained networks, as NAME or NAME@VERSION; ModelService in model_service.proto says what the
  /// server does, and its errors.
  StatusOr<std::vector<api::Model>> ListModels();
  StatusOr<api::Model> GetModel(const std::string& model);
  /// `artifact` is an uploaded model file, or one that a training job made.
  StatusOr<api::Model> ImportModel(const std::string& name, const std::string& artifact);
  /// The artifact to download.
  StatusOr<StoredArtifact> ExportModel(const std::string& model);
  StatusOr<api::Model> SetDefaultModel(const std::string& model);
  Status DeleteModel(const std::string& model);

  /// Training data; DataService in data_service.proto. `artifact` is an uploaded set of clips
  /// (motion/dataset/clip_set_file.h).
  StatusOr<api::DataSet> CreateDataSet(const std::string& name, const std::string& artifact);
  StatusOr<api::DataSet> GetDataSet(const std::string& name);
  StatusOr<std::vector<api::DataSet>> ListDataSets();
  Status DeleteDataSet(const std::string& name);

  /// For operators. `path` lies below the server's data folder and must not exist.
  StatusOr<std::vector<Finding>> Doctor();
  StatusOr<StoreBackup> BackUp(const std::string& path);

  /// Whether the server takes calls; one that drains says kNotServing.
  StatusOr<ServerHealth> Health();

 private:
  explicit Client(std::unique_ptr<Connection> connection);

  // Puts artifacts in the place of large sources.
  Status UploadLargeSources(api::AugmentSpec& spec);

  std::unique_ptr<Connection> connection_;
};

}  // namespace poise::client

#endif  // POISE_CLIENT_CLIENT_H_
