// `poise data` and `poise models` against a real poised.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/artifacts/model_artifact.h"
#include "core/motion/io/clip_file.h"
#include "tests/client/cli/poise_program.h"
#include "tests/support/data_files.h"
#include "tests/support/test_clips.h"

namespace poise::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class ModelsCommandTest : public ::testing::Test {
 protected:
  PoiseRun Poise(std::vector<std::string> arguments) {
    arguments.push_back("--json");
    return server_.Poise(std::move(arguments));
  }
  static base::Json ReadJson(const std::string& path) {
    return base::Json::parse(std::ifstream(path), nullptr, /*allow_exceptions=*/false);
  }
  std::string Path(const std::string& below) const { return server_.Path(below); }

  PoiseServer server_{/*workers=*/1};
};

TEST_F(ModelsCommandTest, AFolderOfClipsBecomesADataSet) {
  fs::create_directories(Path("clips/wave"));
  ASSERT_TRUE(motion::WriteBvhFile(Path("clips/wave/a.bvh"), SwingingClip(31, 30)).ok());
  const PoiseRun added = Poise({"data", "add", "waves", Path("clips"), "--license", "mine"});
  ASSERT_EQ(added.exit_code, 0) << added.out << added.err;
  const base::Json set = added.JsonLines().back();
  EXPECT_EQ(set["clips"], 1);
  EXPECT_EQ(set["actions"]["wave"], 1);
  EXPECT_EQ(set["license"], "mine");
  EXPECT_EQ(Poise({"data", "get", "waves"}).JsonLines().back(), set);
  EXPECT_EQ(Poise({"data", "list"}).JsonLines().size(), 1u);
  EXPECT_EQ(Poise({"data", "delete", "waves"}).exit_code, 0);
  EXPECT_EQ(Poise({"data", "get", "waves"}).exit_code, 3);
  std::ofstream(Path("clips/wave/b.bvh")) << "nonsense";
  const PoiseRun broken = Poise({"data", "add", "waves", Path("clips")});
  EXPECT_EQ(broken.exit_code, 2);
  EXPECT_THAT(std::string(broken.Error()["message"]), HasSubstr("wave/b.bvh"));
}

TEST_F(ModelsCommandTest, Hdm05IsAddedWhole) {
  POISE_REQUIRE_DATA("hdm05");
  const PoiseRun added =
      Poise({"data", "add", "hdm05", DataPath("hdm05").string(), "--license", "CC BY-SA 3.0"});
  ASSERT_EQ(added.exit_code, 0) << added.out << added.err;
  const base::Json set = added.JsonLines().back();
  EXPECT_EQ(set["clips"], 226);
  EXPECT_EQ(set["frames"], 58517);
  EXPECT_EQ(set["actors"].size(), 5u);
  EXPECT_EQ(set["actions"]["kickLFront1Reps"], 28);
}

TEST_F(ModelsCommandTest, ANetworkIsTrainedByAJobAndMakesMotions) {
  fs::create_directories(Path("clips/swing"));
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(motion::WriteBvhFile(Path("clips/swing/" + std::to_string(i) + ".bvh"),
                                     SwingingClip(60, 120, 0.3, i))
                    .ok());
  }
  ASSERT_EQ(Poise({"data", "add", "swings", Path("clips"), "--license", "mine"}).exit_code, 0);
  const std::vector<std::string> train = {
      "train",  "vae",           "--data", "swings",      "--class", "swing",
      "--name", "swing",         "--seed", "3",           "--set",   "trainer.steps=20",
      "--set",  "net.hidden=16", "--set",  "net.latent=4"};
  const PoiseRun trained = Poise(train);
  ASSERT_EQ(trained.exit_code, 0) << trained.out << trained.err;
  const base::Json model = trained.JsonLines().back();
  EXPECT_EQ(model["version"], "1");
  EXPECT_EQ(model["card"]["data_license"], "mine");
  EXPECT_EQ(model["card"]["steps"], 20);
  EXPECT_EQ(model["card"]["seed"], 3);
  EXPECT_EQ(Poise(train).JsonLines().back()["version"], "1") << "the same seed, the same model";
  const PoiseRun made = Poise({"augment", Path("clips/swing/0.bvh"), "--method", "vae+timewarp",
                               "--model", "swing", "-n", "3", "--out", Path("made")});
  ASSERT_EQ(made.exit_code, 0) << made.out << made.err;
  EXPECT_EQ(made.JsonLines().size(), 3u);
  const PoiseRun corrected =
      Poise({"correct", Path("clips/swing/0.bvh"), "--method", "vae", "--model", "swing", "-n", "2",
             "--effort", "instant", "--out", Path("corrected")});
  ASSERT_EQ(corrected.exit_code, 0) << corrected.out << corrected.err;
  EXPECT_EQ(corrected.JsonLines().back()["variants"].size(), 2u);
  const base::Json manifest = ReadJson(Path("corrected/0.json"));
  EXPECT_EQ(manifest["parameters"]["model"], "swing@1") << "pinned at submission";
  const PoiseRun nameless =
      Poise({"correct", Path("clips/swing/0.bvh"), "--method", "vae", "--out", Path("none")});
  EXPECT_EQ(nameless.exit_code, 2);
  EXPECT_EQ(nameless.Error()["reason"], "MISSING_MODEL");
  const PoiseRun without = Poise({"augment", Path("clips/swing/0.bvh"), "--method", "vae"});
  EXPECT_EQ(without.exit_code, 2);
  EXPECT_EQ(without.Error()["reason"], "MISSING_MODEL");
  const PoiseRun typo =
      Poise({"train", "vae", "--data", "swings", "--name", "swing", "--set", "trainer.stepz=20"});
  EXPECT_EQ(typo.exit_code, 2);
  EXPECT_EQ(typo.Error()["reason"], "UNKNOWN_CONFIG_KEY");
}

TEST_F(ModelsCommandTest, APredictorIsTrainedTestedAndAnswersByItsName) {
  fs::create_directories(Path("clips/swing"));
  for (const std::string actor : {"aa", "bb"}) {
    for (int i = 0; i < 2; ++i) {
      const std::string name = "HDM_" + actor + "_swing_" + std::to_string(i);
      ASSERT_TRUE(
          motion::WriteBvhFile(Path("clips/swing/" + name + ".bvh"), SwingingClip(300, 120, 0.3, i))
              .ok());
    }
  }
  ASSERT_EQ(Poise({"data", "add", "swings", Path("clips"), "--license", "mine"}).exit_code, 0);
  const PoiseRun trained = Poise({"train",      "predictor",
                                  "--data",     "swings",
                                  "--hold-out", "bb",
                                  "--name",     "swing-next",
                                  "--seed",     "3",
                                  "--set",      "trainer.steps=20",
                                  "--set",      "members=1",
                                  "--set",      "mixer.width=16",
                                  "--set",      "mixer.hidden=16",
                                  "--set",      "mixer.blocks=1",
                                  "--set",      "mixer.future_frames=12"});
  ASSERT_EQ(trained.exit_code, 0) << trained.out << trained.err;
  const base::Json model = trained.JsonLines().back();
  EXPECT_EQ(model["card"]["family"], "mixer");
  EXPECT_EQ(model["card"]["steps"], 20);
  EXPECT_EQ(model["card"]["trained_on"], "all classes, without actor bb");
  EXPECT_EQ(model["card"]["data_license"], "mine");
  const PoiseRun curve = Poise({"jobs", "result", model["job"], "--out", Path("result")});
  EXPECT_TRUE(fs::exists(Path("result/learning_curve.csv"))) << curve.out;
  const PoiseRun predicted = Poise({"predict", Path("clips/swing/HDM_bb_swing_0.bvh"), "--model",
                                    "swing-next", "--horizon", "0.3", "--out", Path("next.bvh")});
  ASSERT_EQ(predicted.exit_code, 0) << predicted.out << predicted.err;
  EXPECT_EQ(predicted.JsonLines().back()["model"], "swing-next@1");
  const PoiseRun tested = Poise({"evaluate", "predictor", "swing-next", "--data", "swings",
                                 "--hold-out", "bb", "--out", Path("scores.csv")});
  ASSERT_EQ(tested.exit_code, 0) << tested.out << tested.err;
  const base::Json report = tested.JsonLines().back();
  ASSERT_EQ(report["models"].size(), 3u);
  EXPECT_EQ(report["models"][0]["model"], "zero-velocity@1");
  EXPECT_EQ(report["models"][2]["model"], "swing-next@1");
  EXPECT_EQ(report["models"][2]["windows"], 2 * (75 - 24 + 1));
  EXPECT_GT(report["models"][2]["errors"][3], 0);
  std::ifstream csv(Path("scores.csv"));
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "task,model,preset,protocol,action,frame,horizon_ms,seed,metric,value");
  const PoiseRun nobody = Poise({"evaluate", "predictor", "--data", "swings", "--hold-out", "cc"});
  EXPECT_EQ(nobody.JsonLines().back()["error"]["reason"], "NO_CLIPS") << nobody.out;
  const PoiseRun typo = Poise(
      {"train", "predictor", "--data", "swings", "--name", "next", "--set", "mixer.widht=20"});
  EXPECT_EQ(typo.Error()["reason"], "UNKNOWN_CONFIG_KEY");
}

TEST_F(ModelsCommandTest, WhatImitationChangesIsLearnedByAJobAndUndone) {
  fs::create_directories(Path("clips/strike"));
  for (const char* clip : {"kick.bvh", "punch.bvh"}) {
    fs::copy(std::string(POISE_SAMPLES_DIR) + "/" + clip, Path("clips/strike") + "/" + clip);
  }
  ASSERT_EQ(Poise({"data", "add", "strikes", Path("clips")}).exit_code, 0);
  const PoiseRun trained = Poise({"train", "debias", "--data", "strikes", "--class", "strike",
                                  "--name", "habits", "--seed", "3", "--set", "trainer.steps=100"});
  ASSERT_EQ(trained.exit_code, 0) << trained.out << trained.err;
  const base::Json model = trained.JsonLines().back();
  EXPECT_EQ(model["card"]["family"], "debias");
  EXPECT_LT(model["scores"]["debiased_rad"], model["scores"]["imitated_rad"]);
  const auto correct = [&](const std::string& out, std::vector<std::string> more) {
    std::vector<std::string> arguments = {"correct",  Path("clips/strike/kick.bvh"),
                                          "--method", "none",
                                          "--effort", "instant",
                                          "--out",    Path(out)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Poise(std::move(arguments));
  };
  const PoiseRun debiased = correct("debiased", {"--debias", "habits"});
  ASSERT_EQ(debiased.exit_code, 0) << debiased.out << debiased.err;
  EXPECT_EQ(ReadJson(Path("debiased/kick.json"))["parameters"]["debias"], "habits@1");
  ASSERT_EQ(correct("imitated", {}).exit_code, 0);
  const auto read = [&](const std::string& folder) {
    std::ifstream file(Path(folder) + "/kick_none_000.bvh");
    return std::string(std::istreambuf_iterator<char>(file), {});
  };
  EXPECT_FALSE(read("imitated").empty());
  EXPECT_NE(read("debiased"), read("imitated"));
  ASSERT_TRUE(motion::WriteBvhFile(Path("clips/slow.bvh"), SwingingClip(30, 60, 0.1, 0)).ok());
  const PoiseRun slow = Poise({"correct", Path("clips/slow.bvh"), "--method", "none", "--debias",
                               "habits", "--out", Path("slow")});
  EXPECT_EQ(slow.exit_code, 8);
  EXPECT_THAT(slow.out + slow.err, HasSubstr("SIGNATURE_MISMATCH"));
}

TEST_F(ModelsCommandTest, AJobThatNobodyWaitsForGivesItsModelTheName) {
  std::filesystem::create_directories(Path("clips/swing"));
  for (int i = 0; i < 3; ++i) {
    ASSERT_TRUE(motion::WriteBvhFile(Path("clips/swing/" + std::to_string(i) + ".bvh"),
                                     SwingingClip(60, 120, 0.3, i))
                    .ok());
  }
  ASSERT_EQ(Poise({"data", "add", "swings", Path("clips")}).exit_code, 0);
  const PoiseRun detached = Poise({"train", "vae", "--data", "swings", "--name", "swing", "--set",
                                   "trainer.steps=5", "--set", "net.hidden=16", "--detach"});
  ASSERT_EQ(detached.exit_code, 0) << detached.out << detached.err;
  const std::string job = detached.JsonLines().back()["name"];
  ASSERT_EQ(Poise({"jobs", "watch", job}).exit_code, 0);
  const PoiseRun model = Poise({"models", "get", "swing"});
  ASSERT_EQ(model.exit_code, 0) << model.out << model.err;
  EXPECT_EQ(model.JsonLines().back()["card"]["steps"], 5);
  const PoiseRun bad = Poise({"train", "vae", "--data", "swings", "--name", "no name"});
  EXPECT_EQ(bad.Error()["reason"], "BAD_MODEL_NAME");
}

TEST_F(ModelsCommandTest, MadeMotionsAreHeldAgainstTheClipsTheyWereMadeFrom) {
  for (const char* folder : {"clips/swing", "made"}) {
    std::filesystem::create_directories(Path(folder));
    for (int i = 0; i < 3; ++i) {
      ASSERT_TRUE(motion::WriteBvhFile(Path(folder + ("/" + std::to_string(i)) + ".bvh"),
                                       SwingingClip(60, 120, 0.3, i))
                      .ok());
    }
  }
  const PoiseRun same = Poise({"evaluate", "synthesis", Path("made"), "--data", Path("clips")});
  ASSERT_EQ(same.exit_code, 0) << same.out << same.err;
  const base::Json measures = same.JsonLines().back();
  EXPECT_EQ(measures["made"], 3);
  EXPECT_EQ(measures["min_dtw"], 0);
  EXPECT_EQ(measures["diversity"], measures["diversity_training"]);
  const PoiseRun nobody =
      Poise({"evaluate", "synthesis", Path("made"), "--data", Path("clips"), "--hold-out", "tr"});
  EXPECT_EQ(nobody.exit_code, 2);
  EXPECT_EQ(nobody.Error()["reason"], "TOO_FEW_MOTIONS");
}

TEST_F(ModelsCommandTest, AModelIsImportedExportedAndDeleted) {
  artifacts::ModelArtifact model;
  model.card.family = "vae";
  model.card.signature.roles = motion::RequiredRoles();
  model.weights.tensors["w"] = base::TensorRecord::FromFloats({1}, std::vector<float>{1});
  std::ofstream(Path("kick.safetensors"), std::ios::binary) << artifacts::PackModel(model);
  const PoiseRun imported = Poise({"models", "import", "kick", Path("kick.safetensors")});
  ASSERT_EQ(imported.exit_code, 0) << imported.out << imported.err;
  EXPECT_EQ(imported.JsonLines().back()["version"], "1");
  const PoiseRun exported = Poise({"models", "export", "kick@1", "--out", Path("again")});
  ASSERT_EQ(exported.exit_code, 0) << exported.out;
  std::ifstream again(Path("again"), std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(again), {}};
  EXPECT_EQ(bytes, artifacts::PackModel(model));
  EXPECT_EQ(Poise({"models", "list"}).JsonLines().front()["card"]["family"], "vae");
  EXPECT_EQ(Poise({"models", "default", "kick@1"}).exit_code, 0);
  EXPECT_EQ(Poise({"models", "delete", "kick@1"}).exit_code, 0);
  EXPECT_EQ(Poise({"models", "get", "kick"}).exit_code, 3);
}

}  // namespace
}  // namespace poise::testing
