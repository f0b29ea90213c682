#include "client/transport_error.h"

#include <gmock/gmock.h>

#include "proto/convert/status_convert.h"

namespace poise::client {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

ClientOptions At(const std::string& server) {
  ClientOptions options;
  options.server = server;
  return options;
}

grpc::Status Unavailable(const std::string& message) {
  return {grpc::StatusCode::UNAVAILABLE, message};
}

TEST(TransportErrorTest, AMissingLocalServerIsToldWithTheCommandThatStartsIt) {
  const Status status =
      ExplainCall(Unavailable("failed to connect to all addresses; last error: Connection refused"),
                  At("localhost:7000"));
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(base::ErrorReason(status), "NO_SERVER");
  EXPECT_THAT(base::Message(status), HasSubstr("poised --listen localhost:7000"));
  EXPECT_THAT(base::Message(status), Not(HasSubstr("\n")));
}

TEST(TransportErrorTest, AMissingRemoteServerIsNotToldToStartOneHere) {
  const Status status =
      ExplainCall(Unavailable("failed to connect to all addresses"), At("gpu7:50051"));
  EXPECT_THAT(base::Message(status), HasSubstr("POISE_SERVER"));
  EXPECT_THAT(base::Message(status), Not(HasSubstr("poised --listen")));
}

TEST(TransportErrorTest, AnAddressThatCannotBeResolvedNamesTheOption) {
  const Status status =
      ExplainCall(Unavailable("DNS resolution failed for nowhere:1"), At("nowhere:1"));
  EXPECT_EQ(base::ErrorReason(status), "BAD_SERVER_ADDRESS");
  EXPECT_EQ(base::ErrorField(status), "server");
}

TEST(TransportErrorTest, ABrokenConnectionIsUnavailableToo) {
  const Status status = ExplainCall(Unavailable("Socket closed"), {});
  EXPECT_EQ(base::ErrorReason(status), "CONNECTION_LOST");
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
}

TEST(TransportErrorTest, WhatPoiseSaysPassesUnchanged) {
  const Status said = base::MakeError(absl::StatusCode::kUnavailable, "DRAINING", "", "going away");
  const Status status = ExplainCall(convert::ToGrpc(said), {});
  EXPECT_EQ(base::ErrorReason(status), "DRAINING");
  EXPECT_EQ(base::Message(status), "going away");
}

TEST(TransportErrorTest, ACallWithoutATokenSaysHowToGiveOne) {
  const Status said =
      base::MakeError(absl::StatusCode::kUnauthenticated, "BAD_TOKEN", "", "who are you");
  EXPECT_THAT(base::Message(ExplainCall(convert::ToGrpc(said), {})), HasSubstr("POISE_TOKEN"));
  ClientOptions with_token;
  with_token.token = "secret";
  EXPECT_EQ(base::Message(ExplainCall(convert::ToGrpc(said), with_token)), "who are you");
}

}  // namespace
}  // namespace poise::client
