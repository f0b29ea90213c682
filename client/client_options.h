#ifndef POISE_CLIENT_CLIENT_OPTIONS_H_
#define POISE_CLIENT_CLIENT_OPTIONS_H_

#include <cstddef>
#include <string>

#include "absl/time/time.h"

namespace poise::client {

/// Which server, and how to talk to it.
struct ClientOptions {
  std::string server = "127.0.0.1:50051";  ///< host:port
  std::string token;                       ///< sent as a bearer token; empty = none
  /// Longest time that one call may take; the server has limits of its own.
  absl::Duration timeout = absl::InfiniteDuration();
  absl::Duration connect_timeout = absl::Seconds(5);
  /// Sources of one request above this many bytes in all are uploaded first, the largest first.
  size_t inline_bytes = size_t{16} << 20;

  /// The defaults, with `server` from POISE_SERVER and `token` from POISE_TOKEN where those are
  /// set.
  static ClientOptions FromEnvironment();
};

}  // namespace poise::client

#endif  // POISE_CLIENT_CLIENT_OPTIONS_H_
