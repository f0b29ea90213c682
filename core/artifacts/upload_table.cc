#include "core/artifacts/upload_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace poise::artifacts {
namespace {

constexpr size_t kMinIdLength = 16;
constexpr size_t kMaxIdLength = 64;

bool IsIdCharacter(char c) {
  return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' ||
         c == '_';
}

}  // namespace

Status CheckUploadId(std::string_view id) {
  if (id.size() >= kMinIdLength && id.size() <= kMaxIdLength &&
      std::all_of(id.begin(), id.end(), IsIdCharacter)) {
    return absl::OkStatus();
  }
  return base::InvalidArgument(
      "BAD_UPLOAD_ID", "upload_id",
      fmt::format("'{}' is no id of an upload, expected {} to {} letters, digits, '-' and '_'",
                  id.substr(0, kMaxIdLength), kMinIdLength, kMaxIdLength));
}

Status UploadClaim::Check() const {
  if (upload_->last_claim == number_) return absl::OkStatus();
  return base::MakeError(absl::StatusCode::kAborted, "UPLOAD_TAKEN_OVER", "upload_id",
                         "a later stream goes on with this upload");
}

StatusOr<std::unique_lock<std::mutex>> UploadClaim::Lock() const {
  std::unique_lock lock(upload_->mutex);
  POISE_RETURN_IF_ERROR(Check());
  return lock;
}

UploadClaim UploadTable::Claim(const std::string& id) {
  std::lock_guard lock(mutex_);
  std::erase_if(uploads_, [](const auto& entry) { return entry.second.expired(); });
  std::weak_ptr<UploadClaim::Upload>& entry = uploads_[id];
  std::shared_ptr<UploadClaim::Upload> upload = entry.lock();
  if (upload == nullptr) {
    upload = std::make_shared<UploadClaim::Upload>();
    entry = upload;
  }
  const uint64_t number = ++upload->last_claim;
  return UploadClaim(std::move(upload), number);
}

bool UploadTable::IsClaimed(const std::string& id) const {
  std::lock_guard lock(mutex_);
  const auto entry = uploads_.find(id);
  return entry != uploads_.end() && !entry->second.expired();
}

}  // namespace poise::artifacts
