#ifndef POISE_CLIENT_CLI_PUSH_TAKES_H_
#define POISE_CLIENT_CLI_PUSH_TAKES_H_

#include <string>

#include "client/cli/console.h"
#include "client/client.h"

namespace poise::cli {

/// Reads the recorded pushes of a folder (FZJ Push) and keeps them on the server as one take file.
/// Returns the artifact. Errors: those of push::ReadTakes and Client::Upload.
StatusOr<std::string> UploadTakes(client::Client& client, const std::string& folder,
                                  const Console& console);

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_PUSH_TAKES_H_
