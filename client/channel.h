#ifndef POISE_CLIENT_CHANNEL_H_
#define POISE_CLIENT_CHANNEL_H_

#include <memory>
#include <string>

#include "client/client_options.h"
#include "grpcpp/channel.h"

namespace poise::client {

/// A connection that outlives its server: calls that can be repeated without harm wait for a server
/// that is gone for a while (ClientOptions::outage) and are sent again when it goes away under
/// them. Streams are not: who reads one knows where to go on (JobWatch, ArtifactTransfer).
std::shared_ptr<grpc::Channel> MakeChannel(const ClientOptions& options);

/// What gRPC calls the servers: "ipv4:A,B" for a list of addresses, else as given.
std::string ChannelTarget(const std::string& server);

}  // namespace poise::client

#endif  // POISE_CLIENT_CHANNEL_H_
