#include "core/artifacts/model_registry.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "tests/support/temporary_folder.h"

namespace poise::artifacts {
namespace {

namespace fs = std::filesystem;

ModelArtifact MadeModel(float weight) {
  ModelArtifact model;
  model.card = {.family = "vae",
                .preset = "recommended",
                .config = {{"latent", 32}},
                .signature = {.roles = motion::RequiredRoles()},
                .normalisation = {{"scale", {1.5, 2}}},
                .data = "hdm05",
                .data_fingerprint = "abc",
                .trained_on = "class kick",
                .data_license = "CC BY-SA 3.0",
                .seed = 18446744073709551615u,
                .steps = 2000,
                .scores = {{"validation", 0.25}},
                .program_version = "0.1.0",
                .weights_sha256 = ""};
  model.weights.tensors["w"] = base::TensorRecord::FromFloats({1}, std::vector<float>{weight});
  return model;
}

class ModelRegistryTest : public ::testing::Test {
 protected:
  ModelRegistryTest() { Open(); }
  void Open() {
    registry_.reset();
    auto registry = ModelRegistry::Open(
        {.root = folder_.path() / "models", .shipped = folder_.path() / "ship"});
    ASSERT_TRUE(registry.ok()) << registry.status();
    registry_ = *std::move(registry);
  }
  std::string Import(const std::string& name, float weight) {
    const auto model = registry_->Import(name, MadeModel(weight));
    EXPECT_TRUE(model.ok()) << model.status();
    return model.ok() ? model->version : "";
  }
  // Weight of what a reference means.
  float Weight(const std::string& text) {
    const auto reference = api::ModelReference::Parse(text);
    const auto model = registry_->Load(*reference);
    if (!model.ok()) return -1;
    return model->weights.Floats("w", std::vector<int64_t>{1}).value()[0];
  }

  testing::TemporaryFolder folder_;
  std::unique_ptr<ModelRegistry> registry_;
};

TEST_F(ModelRegistryTest, VersionsCountUpAndTheBareNameIsTheNewest) {
  EXPECT_EQ(Import("kick", 1), "1");
  EXPECT_EQ(Import("kick", 2), "2");
  EXPECT_EQ(Weight("kick"), 2);
  EXPECT_EQ(Weight("kick@1"), 1);
  Open();
  EXPECT_EQ(Weight("kick"), 2);
}

TEST_F(ModelRegistryTest, ManyVersionsAreOrderedAsNumbers) {
  for (int i = 1; i <= 11; ++i) Import("kick", static_cast<float>(i));
  EXPECT_EQ(Weight("kick"), 11);
}

TEST_F(ModelRegistryTest, TheSameModelAgainIsTheSameVersion) {
  EXPECT_EQ(Import("kick", 1), "1");
  EXPECT_EQ(Import("kick", 2), "2");
  EXPECT_EQ(Import("kick", 1), "1");
  EXPECT_EQ(registry_->List().size(), 2u);
}

TEST_F(ModelRegistryTest, ADefaultThatWasSetStaysWhenNewerOnesCome) {
  Import("kick", 1);
  Import("kick", 2);
  ASSERT_TRUE(registry_->SetDefault({"kick", "1"}).ok());
  Import("kick", 3);
  Open();
  EXPECT_EQ(Weight("kick"), 1);
  const auto models = registry_->List();
  ASSERT_EQ(models.size(), 3u);
  EXPECT_TRUE(models[0].is_default);
  EXPECT_FALSE(models[2].is_default);
  ASSERT_TRUE(registry_->Delete({"kick", "1"}).ok());
  EXPECT_EQ(Weight("kick"), 3);
}

TEST_F(ModelRegistryTest, TheNumberOfADeletedVersionIsNotGivenAgain) {
  Import("kick", 1);
  Import("kick", 2);
  ASSERT_TRUE(registry_->Delete({"kick", "2"}).ok());
  ASSERT_TRUE(registry_->Delete({"kick", "1"}).ok());
  EXPECT_TRUE(registry_->List().empty());
  EXPECT_EQ(base::ErrorReason(registry_->Get({"kick", ""}).status()), "MODEL_NOT_FOUND");
  Open();
  EXPECT_EQ(Import("kick", 3), "3");
}

TEST_F(ModelRegistryTest, ShippedModelsAreThereAndCannotBeDeleted) {
  fs::create_directories(folder_.path() / "ship/recommended-hdm05/1");
  ASSERT_TRUE(WriteModelFolder(MadeModel(7), folder_.path() / "ship/recommended-hdm05/1").ok());
  EXPECT_EQ(Weight("recommended-hdm05"), 7);
  EXPECT_TRUE(registry_->Get({"recommended-hdm05", ""})->shipped);
  EXPECT_EQ(base::ErrorReason(registry_->Delete({"recommended-hdm05", "1"})), "SHIPPED_MODEL");
  EXPECT_EQ(Import("recommended-hdm05", 8), "2");
  ASSERT_TRUE(registry_->SetDefault({"recommended-hdm05", "1"}).ok());
  EXPECT_EQ(Weight("recommended-hdm05"), 7);
}

TEST_F(ModelRegistryTest, UnknownModelsAreAnsweredWithWhatThereIs) {
  Import("kick", 1);
  EXPECT_EQ(base::Message(registry_->Get({"punch", ""}).status()),
            "there is no model 'punch'; there are: kick");
  EXPECT_EQ(base::Message(registry_->Get({"kick", "9"}).status()),
            "model 'kick' has no version '9'; it has: 1");
  EXPECT_EQ(base::ErrorReason(registry_->Delete({"kick", ""})), "MISSING_VERSION");
}

TEST_F(ModelRegistryTest, NamesThatLeadElsewhereAreRefused) {
  for (const char* name : {"", "..", "../kick", "a/b", "-x", ".staging", "Kick", "a@b@c"}) {
    EXPECT_FALSE(registry_->Import(name, MadeModel(1)).ok()) << name;
    EXPECT_FALSE(registry_->Get({name, ""}).ok()) << name;
  }
  EXPECT_FALSE(api::ModelReference::Parse("kick@../1").ok());
  EXPECT_FALSE(api::ModelReference::Parse("kick@").ok());
}

TEST_F(ModelRegistryTest, SpoiltWeightsAreNoticedAndASpoiltCardHidesOnlyItself) {
  Import("kick", 1);
  Import("punch", 2);
  std::ofstream(folder_.path() / "models/kick/1/weights.safetensors", std::ios::app) << "x";
  EXPECT_EQ(base::ErrorReason(registry_->Load({"kick", "1"}).status()), "CORRUPT_MODEL");
  std::ofstream(folder_.path() / "models/kick/1/card.json") << "{}";
  std::vector<std::string> broken;
  EXPECT_EQ(registry_->List(&broken).size(), 1u);
  ASSERT_EQ(broken.size(), 1u);
  EXPECT_THAT(broken[0], ::testing::HasSubstr("'family' is missing"));
}

TEST(ModelArtifactTest, ACardKeepsEveryFieldThroughOneFile) {
  const std::string bytes = PackModel(MadeModel(3));
  const auto model = UnpackModel(bytes, "model");
  ASSERT_TRUE(model.ok()) << model.status();
  api::ModelCard expected = MadeModel(3).card;
  expected.weights_sha256 = WeightsDigest(MadeModel(3).weights);
  EXPECT_EQ(model->card, expected);
  EXPECT_EQ(PackModel(*model), bytes);
}

TEST(ModelArtifactTest, AFileWithoutACardOrWithOtherWeightsIsRefused) {
  EXPECT_EQ(base::ErrorReason(UnpackModel(base::EncodeTensors({}), "model").status()),
            "MISSING_CARD");
  std::string bytes = PackModel(MadeModel(3));
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  EXPECT_EQ(base::ErrorReason(UnpackModel(bytes, "model").status()), "CORRUPT_MODEL");
}

}  // namespace
}  // namespace poise::artifacts
