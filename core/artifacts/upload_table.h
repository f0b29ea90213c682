#ifndef POISE_CORE_ARTIFACTS_UPLOAD_TABLE_H_
#define POISE_CORE_ARTIFACTS_UPLOAD_TABLE_H_

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

#include "core/base/status.h"

namespace poise::artifacts {

/// 16 to 64 letters, digits, '-' and '_': long enough not to be guessed, and safe as a file's name.
/// Errors: kInvalidArgument BAD_UPLOAD_ID.
Status CheckUploadId(std::string_view id);

/// The right to write to one upload. It ends when a later one for the same upload begins: a client
/// that lost its connection comes back long before the server notices that the old stream is dead.
/// Threads: any.
class UploadClaim {
 public:
  /// Held while the upload's file is touched, so that no two claims do it at once.
  /// Errors: kAborted UPLOAD_TAKEN_OVER.
  StatusOr<std::unique_lock<std::mutex>> Lock() const;
  /// The same test without waiting, for work that takes long under the lock.
  Status Check() const;

 private:
  friend class UploadTable;
  struct Upload {
    std::mutex mutex;
    std::atomic<uint64_t> last_claim = 0;
  };
  UploadClaim(std::shared_ptr<Upload> upload, uint64_t number)
      : upload_(std::move(upload)), number_(number) {}

  std::shared_ptr<Upload> upload_;
  uint64_t number_;
};

/// Who may write to which upload.
/// Threads: any.
class UploadTable {
 public:
  /// Takes the upload over from whoever had it.
  UploadClaim Claim(const std::string& id);
  /// True while somebody holds a claim, valid or not.
  bool IsClaimed(const std::string& id) const;

 private:
  mutable std::mutex mutex_;
  std::map<std::string, std::weak_ptr<UploadClaim::Upload>> uploads_;
};

}  // namespace poise::artifacts

#endif  // POISE_CORE_ARTIFACTS_UPLOAD_TABLE_H_
