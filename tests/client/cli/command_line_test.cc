#include "client/cli/command_line.h"

#include <gmock/gmock.h>

namespace poise::cli {
namespace {

using ::testing::HasSubstr;

class CommandLineTest : public ::testing::Test {
 protected:
  CommandLineTest() : app_("", "poise") {
    CLI::App* augment = app_.add_subcommand("augment", "");
    augment->add_option("FILE", files_)->required();
    augment->add_option("--method", method_);
    augment->add_option("-n,--variants", count_);
    AddJsonFlag(*augment);
    app_.add_subcommand("info", "");
    CLI::App* jobs = app_.add_subcommand("jobs", "");
    jobs->add_subcommand("list", "")->add_option("--state", state_);
    jobs->add_subcommand("cancel", "");
  }

  StatusOr<bool> Parse(std::vector<const char*> arguments) {
    arguments.insert(arguments.begin(), "poise");
    return ParseCommandLine(app_, static_cast<int>(arguments.size()), arguments.data());
  }

  void ExpectError(std::vector<const char*> arguments, const std::string& reason,
                   const std::string& message) {
    const Status status = Parse(std::move(arguments)).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_EQ(base::ErrorReason(status), reason);
    EXPECT_THAT(base::Message(status), HasSubstr(message));
  }

  CLI::App app_;
  std::vector<std::string> files_;
  std::string method_;
  std::string state_;
  int count_ = 0;
};

TEST_F(CommandLineTest, GoodFlagsAreParsed) {
  const auto parsed = Parse({"augment", "a.bvh", "b.bvh", "--method", "ik", "-n", "3"});
  ASSERT_TRUE(parsed.ok()) << parsed.status();
  EXPECT_TRUE(*parsed);
  EXPECT_EQ(files_.size(), 2u);
  EXPECT_EQ(method_, "ik");
  EXPECT_EQ(count_, 3);
}

TEST_F(CommandLineTest, ACommandBelowACommandIsParsed) {
  const auto parsed = Parse({"jobs", "list", "--state", "FAILED"});
  ASSERT_TRUE(parsed.ok()) << parsed.status();
  EXPECT_EQ(state_, "FAILED");
}

TEST_F(CommandLineTest, MistakesBelowACommandNameTheNearestThere) {
  ExpectError({"jobs", "lst"}, "UNKNOWN_COMMAND", "did you mean 'list'?); see 'poise jobs --help'");
  ExpectError({"jobs", "list", "--stat", "x"}, "UNKNOWN_FLAG",
              "did you mean '--state'?); see 'poise jobs list --help'");
  ExpectError({"jobs", "list", "x"}, "BAD_USAGE", "'x'");
  ExpectError({"jobs"}, "BAD_USAGE", "no command given; see 'poise jobs --help'");
}

TEST_F(CommandLineTest, AMistypedCommandNamesTheNearest) {
  ExpectError({"agument", "a.bvh", "--method", "ik"}, "UNKNOWN_COMMAND", "did you mean 'augment'");
}

TEST_F(CommandLineTest, AMistypedFlagNamesTheNearest) {
  ExpectError({"augment", "a.bvh", "--metod", "ik"}, "UNKNOWN_FLAG", "did you mean '--method'");
  ExpectError({"augment", "a.bvh", "--metod=ik"}, "UNKNOWN_FLAG", "did you mean '--method'");
}

TEST_F(CommandLineTest, AMistypedFlagIsToldBeforeAMissingFile) {
  ExpectError({"augment", "--jsn"}, "UNKNOWN_FLAG", "'--json'");
}

TEST_F(CommandLineTest, AMissingFileNamesTheHelp) {
  ExpectError({"augment"}, "BAD_USAGE", "poise augment --help");
}

TEST_F(CommandLineTest, AValueThatIsNoNumberIsRefused) {
  ExpectError({"augment", "a.bvh", "-n", "many"}, "BAD_USAGE", "many");
}

TEST_F(CommandLineTest, NoCommandShowsTheHelp) {
  ::testing::internal::CaptureStderr();
  ExpectError({}, "BAD_USAGE", "no command");
  EXPECT_THAT(::testing::internal::GetCapturedStderr(), HasSubstr("augment"));
}

TEST_F(CommandLineTest, HelpIsAnsweredWithoutAnError) {
  ::testing::internal::CaptureStdout();
  const auto parsed = Parse({"augment", "--help"});
  EXPECT_THAT(::testing::internal::GetCapturedStdout(), HasSubstr("--method"));
  ASSERT_TRUE(parsed.ok());
  EXPECT_FALSE(*parsed);
}

}  // namespace
}  // namespace poise::cli
