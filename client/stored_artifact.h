#ifndef POISE_CLIENT_STORED_ARTIFACT_H_
#define POISE_CLIENT_STORED_ARTIFACT_H_

#include <cstdint>
#include <string>

namespace poise::client {

/// A file that the server keeps.
struct StoredArtifact {
  std::string name;  ///< "artifacts/<sha256>"
  int64_t size_bytes = 0;
  int64_t sent_bytes = 0;  ///< over the wire: 0 when it was there, above the size after a break
};

}  // namespace poise::client

#endif  // POISE_CLIENT_STORED_ARTIFACT_H_
