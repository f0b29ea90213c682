#include "core/runtime/serving/predictor_catalog.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "tests/support/temporary_folder.h"

namespace poise::serving {
namespace {

class PredictorCatalogTest : public ::testing::Test {
 protected:
  PredictorCatalogTest() {
    auto registry = artifacts::ModelRegistry::Open(
        {.root = folder_.path() / "models", .shipped = POISE_SOURCE_DIR "/models"});
    EXPECT_TRUE(registry.ok()) << registry.status();
    registry_ = *std::move(registry);
    catalog_ =
        std::make_unique<PredictorCatalog>(*registry_, ServingConfig{}, base::Telemetry::None());
  }
  void Import(uint64_t seed) {
    auto model = registry_->Load({.name = "predictor-cmu", .version = "1"});
    ASSERT_TRUE(model.ok()) << model.status();
    model->card.seed = seed;
    ASSERT_TRUE(registry_->Import("mine", *model).ok());
  }
  std::string Version(std::string_view model) {
    const auto served = catalog_->Find(model);
    return served.ok() ? served->version : base::ErrorReason(served.status());
  }

  testing::TemporaryFolder folder_;
  std::unique_ptr<artifacts::ModelRegistry> registry_;
  std::unique_ptr<PredictorCatalog> catalog_;
};

TEST_F(PredictorCatalogTest, ANameFollowsTheRegistryAndAVersionStays) {
  EXPECT_EQ(Version("mine"), "UNKNOWN_MODEL");
  Import(1);
  EXPECT_EQ(Version("mine"), "1");
  EXPECT_EQ(Version("mine"), "1") << "remembered";
  Import(2);
  EXPECT_EQ(Version("mine"), "2");
  EXPECT_EQ(Version("mine@1"), "1");
  ASSERT_TRUE(registry_->SetDefault({.name = "mine", .version = "1"}).ok());
  EXPECT_EQ(Version("mine"), "1");
  ASSERT_TRUE(registry_->Delete({.name = "mine", .version = "1"}).ok());
  EXPECT_EQ(Version("mine"), "2");
  EXPECT_EQ(Version("mine@1"), "UNKNOWN_VERSION");
}

TEST_F(PredictorCatalogTest, EveryModelThatShipsIsServedAndTogetherTheyAreSmall) {
  size_t numbers = 0;
  const std::vector<api::Model> models = registry_->List();
  ASSERT_GE(models.size(), 2u);
  for (const api::Model& listed : models) {
    const std::string name = listed.name + "@" + listed.version;
    ASSERT_TRUE(catalog_->Find(name).ok()) << name << ": " << catalog_->Find(name).status();
    const auto model = registry_->Load({.name = listed.name, .version = listed.version});
    ASSERT_TRUE(model.ok()) << name << ": " << model.status();
    EXPECT_FALSE(model->card.scores.empty()) << name;
    EXPECT_FALSE(model->card.data_license.empty()) << name;
    for (const auto& [tensor, values] : model->weights.tensors) numbers += values.bytes.size();
  }
  EXPECT_LT(numbers, 10e6);
}

TEST_F(PredictorCatalogTest, OneModelIsOnePredictorForAll) {
  EXPECT_EQ(catalog_->Find("predictor-cmu")->predictor,
            catalog_->Find("predictor-cmu@1")->predictor);
  EXPECT_EQ(catalog_->Find("predictor-cmu")->gate, catalog_->Find("predictor-cmu")->gate);
  EXPECT_EQ(catalog_->Find("zero-velocity")->gate, nullptr);
}

TEST_F(PredictorCatalogTest, VersionsThatComeUnderTrafficCauseNoError) {
  Import(1);
  std::atomic<bool> done = false;
  std::atomic<int> errors = 0, answers = 0;
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([&] {
      while (!done) {
        const auto served = catalog_->Find("mine");
        errors += served.ok() ? 0 : 1;
        ++answers;
      }
    });
  }
  for (uint64_t seed = 2; seed < 12; ++seed) Import(seed);
  done = true;
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(errors, 0);
  EXPECT_GT(answers, 0);
  EXPECT_EQ(Version("mine"), "11");
}

}  // namespace
}  // namespace poise::serving
