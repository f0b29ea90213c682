#include "client/client.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "client/artifact_transfer.h"
#include "client/connection.h"
#include "client/push_call.h"
#include "client/transport_error.h"
#include "client/variant_call.h"
#include "core/base/sha256.h"
#include "proto/convert/augment_convert.h"
#include "proto/convert/push_convert.h"

namespace poise::client {
namespace {

// About how many bytes a source takes in a request.
size_t WireBytes(const api::ClipSource& source) {
  if (const auto* clip = std::get_if<motion::Clip>(&source.clip)) {
    return (clip->rotations().size() * 4 + clip->root_positions().size() * 3) * sizeof(float);
  }
  if (const auto* file = std::get_if<api::EncodedClip>(&source.clip)) {
    return file->data.size() + file->skeleton_data.size();
  }
  return 0;
}

// Arrays as a file that can be uploaded, read back in the same unit and axes.
api::EncodedClip EncodeArrays(const motion::Clip& clip) {
  motion::SourceConvention metres_y_up;
  return {.name = clip.name() + ".bvh",
          .data = motion::EncodeBvh(clip, metres_y_up),
          .format = motion::ClipFormat::kBvh,
          .skeleton_data = "",
          .hints = {
              .unit_m = metres_y_up.unit_m, .up = metres_y_up.up, .frame_rate = clip.frame_rate()}};
}

}  // namespace

Client::Client(std::unique_ptr<Connection> connection) : connection_(std::move(connection)) {}
Client::~Client() = default;

StatusOr<std::unique_ptr<Client>> Client::Connect(const ClientOptions& options) {
  std::unique_ptr<Client> client(new Client(std::make_unique<Connection>(options)));
  const Status status = client->Health().status();
  if (status.code() == absl::StatusCode::kDeadlineExceeded) {
    return base::MakeError(
        absl::StatusCode::kUnavailable, "NO_SERVER", "server",
        fmt::format("no server answers at {} within {}; check the address "
                    "(--server or POISE_SERVER)",
                    options.server, absl::FormatDuration(options.connect_timeout)));
  }
  POISE_RETURN_IF_ERROR(status);
  return client;
}

StatusOr<ServerHealth> Client::Health() {
  const auto context = connection_->NewCall(connection_->options().connect_timeout);
  grpc::health::v1::HealthCheckResponse response;
  const grpc::Status status = connection_->health().Check(context.get(), {}, &response);
  POISE_RETURN_IF_ERROR(ExplainCall(status, connection_->options()));
  return response.status() == grpc::health::v1::HealthCheckResponse::SERVING
             ? ServerHealth::kServing
             : ServerHealth::kNotServing;
}

StatusOr<std::unique_ptr<VariantStream>> Client::Augment(api::AugmentSpec spec) {
  POISE_RETURN_IF_ERROR(spec.Validate());
  POISE_RETURN_IF_ERROR(UploadLargeSources(spec));
  return std::make_unique<VariantStream>(
      std::make_unique<VariantStream::Call>(*connection_, convert::ToProto(spec)));
}

StatusOr<std::unique_ptr<PushStream>> Client::ForecastPush(const api::PushSpec& spec) {
  POISE_RETURN_IF_ERROR(spec.Validate());
  return std::make_unique<PushStream>(
      std::make_unique<PushStream::Call>(*connection_, convert::ToProto(spec)));
}

Status Client::UploadLargeSources(api::AugmentSpec& spec) {
  std::vector<api::ClipSource>& sources = spec.sources;
  std::vector<size_t> sizes;
  for (const api::ClipSource& source : sources) sizes.push_back(WireBytes(source));
  std::vector<size_t> largest_first(sources.size());
  std::iota(largest_first.begin(), largest_first.end(), 0);
  std::stable_sort(largest_first.begin(), largest_first.end(),
                   [&](size_t a, size_t b) { return sizes[a] > sizes[b]; });
  size_t total = std::accumulate(sizes.begin(), sizes.end(), size_t{0});
  for (const size_t i : largest_first) {
    if (total <= connection_->options().inline_bytes) break;
    if (const auto* clip = std::get_if<motion::Clip>(&sources[i].clip)) {
      sources[i].clip = EncodeArrays(*clip);
    }
    auto* file = std::get_if<api::EncodedClip>(&sources[i].clip);
    if (file == nullptr) break;  // only stored sources are left, which take no room
    const StatusOr<StoredArtifact> stored = Upload(file->data);
    if (!stored.ok()) {
      return base::Annotate(stored.status(), fmt::format("uploading '{}'", file->name),
                            fmt::format("sources[{}]", i));
    }
    sources[i].clip = api::StoredClip{.artifact = stored->name,
                                      .name = file->name,
                                      .format = file->format,
                                      .skeleton_data = std::move(file->skeleton_data),
                                      .hints = file->hints};
    total -= sizes[i];
  }
  return absl::OkStatus();
}

StatusOr<StoredArtifact> Client::Upload(std::string_view data) {
  return client::Upload(*connection_, MemorySource(data));
}

StatusOr<StoredArtifact> Client::UploadFile(const std::filesystem::path& path) {
  POISE_ASSIGN_OR_RETURN(const UploadSource source, FileSource(path));
  return client::Upload(*connection_, source);
}

StatusOr<std::string> Client::Download(const std::string& name, int64_t offset) {
  std::string data;
  POISE_RETURN_IF_ERROR(
      client::Download(*connection_, name, offset, [&data](std::string_view bytes) {
        data += bytes;
        return absl::OkStatus();
      }));
  if (offset == 0 && !IsNamed(name, base::Sha256Hex(data))) {
    return base::Internal("CORRUPTED",
                          fmt::format("what came for '{}' does not hash to its name", name));
  }
  return data;
}

Status Client::DownloadFile(const std::string& name, const std::filesystem::path& path) {
  return DownloadToFile(*connection_, name, path);
}

}  // namespace poise::client
