// ModelService and DataService, through the client library.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/client.h"
#include "core/artifacts/model_artifact.h"
#include "core/motion/dataset/clip_set_file.h"
#include "tests/support/test_clips.h"
#include "tests/support/test_server.h"

namespace poise::server {
namespace {

using testing::TestServer;

void ExpectError(const Status& status, absl::StatusCode code, const std::string& reason,
                 const std::string& field) {
  EXPECT_EQ(status.code(), code) << status;
  EXPECT_EQ(base::ErrorReason(status), reason) << status;
  EXPECT_EQ(base::ErrorField(status), field) << status;
}

class ModelServiceTest : public ::testing::Test {
 protected:
  ModelServiceTest() {
    client::ClientOptions options;
    options.server = server_.server().address();
    client_ = *client::Client::Connect(options);
  }

  std::string UploadModel(float weight) {
    artifacts::ModelArtifact model;
    model.card.family = "vae";
    model.card.signature.roles = motion::RequiredRoles();
    model.weights.tensors["w"] = base::TensorRecord::FromFloats({1}, std::vector<float>{weight});
    return client_->Upload(artifacts::PackModel(model))->name;
  }
  std::string UploadClips(uint64_t seed) {
    motion::ClipSet set{.clips = {}, .license = "mine", .notes = {}};
    set.clips.push_back({"kick", "bd", testing::SwingingClip(31, 30, 0.3, seed)});
    return client_->Upload(motion::EncodeClipSet(set))->name;
  }

  TestServer server_;
  std::unique_ptr<client::Client> client_;
};

TEST_F(ModelServiceTest, AModelGoesInAndComesOutAsItWas) {
  const std::string artifact = UploadModel(1);
  const auto imported = client_->ImportModel("kick", artifact);
  ASSERT_TRUE(imported.ok()) << imported.status();
  EXPECT_EQ(imported->version, "1");
  EXPECT_TRUE(imported->is_default);
  const auto exported = client_->ExportModel("kick");
  ASSERT_TRUE(exported.ok()) << exported.status();
  EXPECT_EQ(exported->name, artifact) << "the same bytes";
}

TEST_F(ModelServiceTest, VersionsAreListedChosenAndDeleted) {
  ASSERT_TRUE(client_->ImportModel("kick", UploadModel(1)).ok());
  ASSERT_TRUE(client_->ImportModel("kick", UploadModel(2)).ok());
  EXPECT_EQ(client_->GetModel("kick")->version, "2");
  ASSERT_TRUE(client_->SetDefaultModel("kick@1").ok());
  EXPECT_EQ(client_->GetModel("kick")->version, "1");
  EXPECT_EQ(client_->ListModels()->size(), 2u);
  ASSERT_TRUE(client_->DeleteModel("kick@1").ok());
  EXPECT_EQ(client_->GetModel("kick")->version, "2");
}

TEST_F(ModelServiceTest, ErrorsNameWhatIsWrong) {
  using Code = absl::StatusCode;
  ASSERT_TRUE(client_->ImportModel("kick", UploadModel(1)).ok());
  ExpectError(client_->GetModel("punch").status(), Code::kNotFound, "MODEL_NOT_FOUND", "model");
  ExpectError(client_->GetModel("../kick").status(), Code::kInvalidArgument, "BAD_MODEL_NAME",
              "name");
  ExpectError(client_->DeleteModel("kick"), Code::kInvalidArgument, "MISSING_VERSION", "model");
  const std::string no_model = client_->Upload("no model at all")->name;
  ExpectError(client_->ImportModel("kick", no_model).status(), Code::kInvalidArgument,
              "MALFORMED_TENSORS", "artifact");
  ExpectError(client_->ImportModel("kick", UploadClips(1)).status(), Code::kInvalidArgument,
              "MISSING_CARD", "artifact");
  ExpectError(client_->ImportModel("kick", "artifacts/" + std::string(64, '0')).status(),
              Code::kNotFound, "ARTIFACT_NOT_FOUND", "artifact");
}

TEST_F(ModelServiceTest, ADataSetIsNamedListedAndDeleted) {
  const auto created = client_->CreateDataSet("kicks", UploadClips(1));
  ASSERT_TRUE(created.ok()) << created.status();
  EXPECT_EQ(created->clips, 1);
  EXPECT_EQ(created->frames, 31);
  EXPECT_EQ(*client_->GetDataSet("kicks"), *created);
  EXPECT_THAT(*client_->ListDataSets(), ::testing::ElementsAre(*created));
  ExpectError(client_->CreateDataSet("kicks", UploadClips(2)).status(),
              absl::StatusCode::kAlreadyExists, "DATA_SET_EXISTS", "name");
  ASSERT_TRUE(client_->DeleteDataSet("kicks").ok());
  ExpectError(client_->GetDataSet("kicks").status(), absl::StatusCode::kNotFound,
              "DATA_SET_NOT_FOUND", "data");
}

}  // namespace
}  // namespace poise::server
