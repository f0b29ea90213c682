#ifndef POISE_CLIENT_CLIENT_OPTIONS_H_
#define POISE_CLIENT_CLIENT_OPTIONS_H_

#include <cstddef>
#include <string>

#include "absl/time/time.h"

namespace poise::client {

/// Which server, and how to talk to it.
struct ClientOptions {
  /// HOST:PORT. Several servers that share their jobs: "IP:PORT,IP:PORT", asked in turn.
  std::string server = "127.0.0.1:50051";
  std::string token;   ///< sent as a bearer token; empty = none
  std::string tenant;  ///< whose jobs; empty = the server's default
  /// Longest time that one call may take; the server has limits of its own.
  absl::Duration timeout = absl::InfiniteDuration();
  absl::Duration connect_timeout = absl::Seconds(5);
  /// How long a server may be gone, after Connect, before a call that can be repeated without harm
  /// fails: everything about jobs, uploads and downloads.
  absl::Duration outage = absl::Seconds(60);
  /// Sources of one request above this many bytes in all are uploaded first, the largest first.
  size_t inline_bytes = size_t{16} << 20;

  /// The defaults, with `server` from POISE_SERVER, `token` from POISE_TOKEN and `tenant` from
  /// POISE_TENANT where those are set.
  static ClientOptions FromEnvironment();
};

}  // namespace poise::client

#endif  // POISE_CLIENT_CLIENT_OPTIONS_H_
