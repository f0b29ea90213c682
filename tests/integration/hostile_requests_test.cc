#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <limits>
#include <map>
#include <string>

#include "core/base/random.h"
#include "tests/support/raw_call.h"
#include "tests/support/sanitizer.h"
#include "tests/support/server_process.h"
#include "tests/support/test_server.h"

namespace poise::server {
namespace {

using base::Random;
using testing::ServerProcess;
using testing::SwingRequest;

constexpr int kRequests = 10'000;

std::string RandomBytes(Random& random) {
  std::string bytes(random.Index(2000), '\0');
  for (char& byte : bytes) byte = static_cast<char>(random.Index(256));
  return bytes;
}

// A valid request with some of its bytes replaced, removed or repeated.
std::string Mutated(Random& random) {
  static const std::string valid = SwingRequest(8, 2).SerializeAsString();
  std::string bytes = valid;
  for (uint64_t i = 0, count = 1 + random.Index(8); i < count && !bytes.empty(); ++i) {
    const size_t at = random.Index(bytes.size());
    switch (random.Index(3)) {
      case 0:
        bytes[at] = static_cast<char>(random.Index(256));
        break;
      case 1:
        bytes.erase(at, random.Index(64));
        break;
      default:
        bytes.insert(at, bytes.substr(random.Index(bytes.size()), random.Index(64)));
        break;
    }
  }
  return bytes;
}

// A well-formed message with numbers and shapes that make no sense.
std::string Absurd(Random& random) {
  v1::AugmentRequest request = SwingRequest(4, 1);
  v1::Clip& clip = *request.mutable_sources(0)->mutable_clip();
  switch (random.Index(12)) {
    case 0:
      request.set_variants_per_source(std::numeric_limits<int32_t>::max());
      break;
    case 1:
      clip.mutable_rotations()->Resize(static_cast<int>(random.Index(5000)), 0.5f);
      break;
    case 2:
      clip.mutable_root_positions()->Resize(static_cast<int>(random.Index(5000)), 3e38f);
      break;
    case 3:
      clip.set_frame_rate(random.Uniform(-1e300, 1e300));
      break;
    case 4:
      for (int i = 0; i < 3000; ++i) clip.mutable_skeleton()->add_joints()->set_parent(i - 5);
      break;
    case 5:
      clip.mutable_skeleton()->mutable_joints(2)->set_parent(static_cast<int>(random.Index(1000)));
      break;
    case 6:
      for (int i = 0; i < 1500; ++i) request.add_sources();
      break;
    case 7:
      request.set_method(std::string(10'000, '+'));
      break;
    case 8:
      (*request.mutable_overrides())["ik.x" + std::to_string(random.Index(1000))] = "nan";
      break;
    case 9:
      for (int i = 0; i < clip.root_positions_size(); ++i) clip.set_root_positions(i, 3e38f);
      break;
    case 10:
      request.mutable_sources(0)->mutable_file()->set_data(
          "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 2000000000 Xposition\n");
      break;
    default:
      request.mutable_sources(0)->mutable_stored()->set_artifact("artifacts/../../../etc/passwd");
      break;
  }
  return request.SerializeAsString();
}

std::string HostileRequest(Random& random) {
  switch (random.Index(3)) {
    case 0:
      return RandomBytes(random);
    case 1:
      return Mutated(random);
    default:
      return Absurd(random);
  }
}

TEST(HostileRequestsTest, TenThousandLeaveTheServerServingItsMemoryFlatAndEveryErrorExplained) {
  ServerProcess server;
  const auto channel = server.NewChannel();
  const std::string methods[] = {"/poise.v1.AugmentationService/Augment",
                                 "/poise.v1.ArtifactService/Upload",
                                 "/poise.v1.ArtifactService/Download"};
  Random random(20261122);
  std::map<std::string, int> reasons;
  const double mib = 1 << 20;
  double warm = 0;
  for (int i = 0; i < kRequests; ++i) {
    if (i == kRequests / 5) warm = server.ResidentBytes() / mib;
    // Most to the method that has the most to get wrong.
    const std::string& method = methods[random.Index(10) < 8 ? 0 : 1 + random.Index(2)];
    const grpc::Status status = testing::RawCall(channel, method, HostileRequest(random), 100);
    ASSERT_NE(status.error_code(), grpc::StatusCode::INTERNAL) << status.error_message();
    const std::string reason = status.ok() ? "OK" : testing::ErrorInfoOf(status).reason();
    ++reasons[reason];
    ASSERT_FALSE(reason.empty()) << method << ": " << status.error_code() << " "
                                 << status.error_message();
  }
  const double end = server.ResidentBytes() / mib;
  std::printf("%d requests; RSS after 2,000: %.0f MiB, at the end: %.0f MiB\n", kRequests, warm,
              end);
  for (const auto& [reason, count] : reasons) std::printf("  %6d %s\n", count, reason.c_str());
  if (!testing::kInstrumented) {
    EXPECT_LT(end, warm + 16);
  }
  EXPECT_EQ(reasons.count("UNEXPECTED_EXCEPTION"), 0u);
  EXPECT_EQ(testing::HealthOf(channel, ""), "SERVING");
}

TEST(HostileRequestsTest, MessageAboveTheLimitIsRefusedAndTheServerGoesOn) {
  ServerProcess server;
  const auto channel = server.NewChannel();
  v1::AugmentRequest request = SwingRequest(4, 1);
  request.mutable_sources(0)->mutable_file()->set_data(std::string(70 << 20, 'x'));
  const grpc::Status status = testing::RawCall(channel, "/poise.v1.AugmentationService/Augment",
                                               request.SerializeAsString());
  EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
  std::printf("70 MiB in one message: %s\n", status.error_message().c_str());
  EXPECT_EQ(testing::HealthOf(channel, ""), "SERVING");
}

}  // namespace
}  // namespace poise::server
