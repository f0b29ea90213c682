#ifndef POISE_CLIENT_ARTIFACT_TRANSFER_H_
#define POISE_CLIENT_ARTIFACT_TRANSFER_H_

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "client/connection.h"
#include "client/stored_artifact.h"
#include "core/base/status.h"

/// Files on their way between here and the server's artifacts, over streams that may break.
namespace poise::client {

/// Where the bytes of an upload come from.
struct UploadSource {
  int64_t size_bytes;
  /// At most `max_bytes` from `offset`, fewer only at the end.
  std::function<StatusOr<std::string>(int64_t offset, int64_t max_bytes)> read;
};

UploadSource MemorySource(std::string_view data);
/// Errors: kNotFound FILE_NOT_FOUND.
StatusOr<UploadSource> FileSource(const std::filesystem::path& path);

/// Sends a file in chunks; after a break asks how much has arrived and goes on there, for as long
/// as ClientOptions::outage allows. What the server has already is not sent.
/// Errors: kInvalidArgument WRONG_DIGEST when the source changed meanwhile.
StatusOr<StoredArtifact> Upload(const Connection& connection, const UploadSource& source);

/// Gives the bytes of an artifact from `offset` on to `sink`, in order and each once, whatever
/// breaks on the way. Does not check the digest. Errors: the sink's.
Status Download(const Connection& connection, const std::string& name, int64_t offset,
                const std::function<Status(std::string_view)>& sink);

/// Into a file, which appears whole and with the right digest or not at all. "<path>.part" holds
/// what has come; a later call goes on with it. A file that is there and right is not fetched.
/// Errors: kInternal CORRUPTED; kFailedPrecondition CANNOT_WRITE.
Status DownloadToFile(const Connection& connection, const std::string& name,
                      const std::filesystem::path& path);

/// True when the digest in the artifact's name is `sha256`.
bool IsNamed(const std::string& artifact, const std::string& sha256);

}  // namespace poise::client

#endif  // POISE_CLIENT_ARTIFACT_TRANSFER_H_
