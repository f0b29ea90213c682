#ifndef POISE_CLIENT_CLIENT_H_
#define POISE_CLIENT_CLIENT_H_

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "client/client_options.h"
#include "client/variant_stream.h"
#include "core/api/augment_spec.h"
#include "core/base/status.h"

namespace poise::client {

class Connection;

/// A file that the server keeps.
struct StoredArtifact {
  std::string name;  ///< "artifacts/<sha256>"
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

  /// Stores a file on the server; the same bytes get the same name.
  /// Errors: kInternal CORRUPTED when the server stored something else.
  StatusOr<StoredArtifact> Upload(std::string_view data);

  /// The bytes of an artifact from byte `offset` on. Errors: kNotFound; kInternal CORRUPTED when a
  /// whole file does not hash to its name.
  StatusOr<std::string> Download(const std::string& name, int64_t offset = 0);

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
