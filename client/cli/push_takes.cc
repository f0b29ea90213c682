#include "client/cli/push_takes.h"

#include <fmt/format.h>

#include <vector>

#include "core/push/takes/fzj_takes.h"
#include "core/push/takes/take_file.h"

namespace poise::cli {

StatusOr<std::string> UploadTakes(client::Client& client, const std::string& folder,
                                  const Console& console) {
  POISE_ASSIGN_OR_RETURN(const std::vector<push::PushTake> takes, push::ReadTakes(folder));
  console.Note(fmt::format("{} takes read", takes.size()));
  POISE_ASSIGN_OR_RETURN(const client::StoredArtifact stored,
                         client.Upload(push::EncodeTakes(takes)));
  return stored.name;
}

}  // namespace poise::cli
