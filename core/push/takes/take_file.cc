#include "core/push/takes/take_file.h"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <utility>

#include "core/base/json.h"
#include "core/base/tensor_file.h"

namespace poise::push {
namespace {

static_assert(std::endian::native == std::endian::little, "tensor files are little-endian");

constexpr const char* kTakes = "takes";
constexpr int kForceSize = 4;

std::string ForceName(size_t take) { return fmt::format("take{}.force", take); }
std::string JointsName(size_t take, size_t person) {
  return fmt::format("take{}.person{}", take, person);
}
std::string RotationsName(size_t take, size_t person) {
  return JointsName(take, person) + ".rotations";
}

// Rows of fixed vectors, whose numbers lie one after the other.
template <typename Vector>
base::TensorRecord ToRecord(const std::vector<Vector>& rows, std::vector<int64_t> shape) {
  base::TensorRecord record{
      .type = base::ElementType::kFloat64, .shape = std::move(shape), .bytes = {}};
  for (const Vector& row : rows) {
    record.bytes.append(reinterpret_cast<const char*>(row.data()), sizeof(double) * row.size());
  }
  return record;
}

Status Malformed(std::string_view what, const std::string& problem) {
  return base::InvalidArgument("MALFORMED_TAKE", "", fmt::format("{}: {}", what, problem));
}

template <typename Vector>
StatusOr<std::vector<Vector>> FromRecord(const base::TensorFile& file, const std::string& name,
                                         const std::vector<int64_t>& shape) {
  POISE_ASSIGN_OR_RETURN(const base::TensorRecord* record, file.Find(name));
  if (record->type != base::ElementType::kFloat64 || record->shape != shape) {
    return Malformed(name, fmt::format("has shape {}, expected {} in double precision",
                                       base::ShapeText(record->shape), base::ShapeText(shape)));
  }
  constexpr size_t kSize = Vector::SizeAtCompileTime;
  std::vector<Vector> rows(record->bytes.size() / (kSize * sizeof(double)));
  for (size_t row = 0; row < rows.size(); ++row) {
    std::memcpy(rows[row].data(), record->bytes.data() + row * kSize * sizeof(double),
                kSize * sizeof(double));
    if (!rows[row].allFinite()) return Malformed(name, "holds something that is no number");
  }
  return rows;
}

base::Json Describe(const PushTake& take) {
  base::Json people = base::Json::array();
  for (const TakePerson& person : take.people) {
    people.push_back({{"file", person.file},
                      {"suit", person.suit},
                      {"mass_kg", person.mass_kg},
                      {"stated_onset", person.stated_onset}});
  }
  return {{"group", take.group},
          {"index", take.index},
          {"test", take.split == Split::kTest},
          {"multi", take.multi},
          {"session", take.session},
          {"level", take.level},
          {"frames", take.frames},
          {"forces", take.force.size()},
          {"push_frames", take.push_frames},
          {"people", std::move(people)}};
}

StatusOr<PushTake> ReadTake(const base::TensorFile& file, size_t index, const base::Json& json) {
  PushTake take{.group = json.at("group").get<std::string>(),
                .index = base::IntegerFrom<int>(json.at("index")),
                .split = json.at("test").get<bool>() ? Split::kTest : Split::kTrain,
                .multi = json.at("multi").get<bool>(),
                .session = json.at("session").get<std::string>(),
                .level = json.at("level").get<std::string>(),
                .frames = base::IntegerFrom<int>(json.at("frames")),
                .people = {},
                .force = {},
                .push_frames = base::IntegerFrom<int>(json.at("push_frames"))};
  const auto forces = base::IntegerFrom<int64_t>(json.at("forces"));
  if (take.frames < 2 || take.push_frames < 1 || take.push_frames > forces) {
    return Malformed(take.name(), "its frames or forces are too few");
  }
  POISE_ASSIGN_OR_RETURN(
      take.force, FromRecord<GeneralisedForce>(file, ForceName(index), {forces, kForceSize}));
  for (const base::Json& person : json.at("people")) {
    TakePerson read{.file = person.at("file").get<std::string>(),
                    .suit = person.at("suit").get<std::string>(),
                    .mass_kg = person.at("mass_kg").get<double>(),
                    .stated_onset = base::IntegerFrom<int>(person.at("stated_onset"))};
    if (!(read.mass_kg > 0)) return Malformed(read.file, "a mass must be greater than 0");
    POISE_ASSIGN_OR_RETURN(read.joints,
                           FromRecord<Vec3>(file, JointsName(index, take.people.size()),
                                            {take.frames, kBodyJoints, 3}));
    POISE_ASSIGN_OR_RETURN(const auto rotations, FromRecord<Eigen::Vector4d>(
                                                     file, RotationsName(index, take.people.size()),
                                                     {take.frames, kBodyJoints, 4}));
    for (const Eigen::Vector4d& rotation : rotations) read.rotations.emplace_back(rotation);
    take.people.push_back(std::move(read));
  }
  if (take.people.empty()) return Malformed(take.name(), "has no people");
  return take;
}

}  // namespace

std::string EncodeTakes(const std::vector<PushTake>& takes) {
  base::TensorFile file;
  base::Json list = base::Json::array();
  for (size_t i = 0; i < takes.size(); ++i) {
    const PushTake& take = takes[i];
    list.push_back(Describe(take));
    file.tensors[ForceName(i)] =
        ToRecord(take.force, {static_cast<int64_t>(take.force.size()), kForceSize});
    for (size_t person = 0; person < take.people.size(); ++person) {
      file.tensors[JointsName(i, person)] =
          ToRecord(take.people[person].joints, {take.frames, kBodyJoints, 3});
      std::vector<Eigen::Vector4d> rotations;
      for (const math::Quat& rotation : take.people[person].rotations) {
        rotations.push_back(rotation.coeffs());
      }
      file.tensors[RotationsName(i, person)] = ToRecord(rotations, {take.frames, kBodyJoints, 4});
    }
  }
  file.metadata[kTakes] = list.dump();
  return base::EncodeTensors(file);
}

StatusOr<std::vector<PushTake>> DecodeTakes(std::string_view bytes, std::string_view what) {
  POISE_ASSIGN_OR_RETURN(const base::TensorFile file, base::DecodeTensors(bytes, what));
  const auto text = file.metadata.find(kTakes);
  if (text == file.metadata.end()) return Malformed(what, "holds no takes");
  POISE_ASSIGN_OR_RETURN(const base::Json list, base::ParseJson(text->second, what));
  std::vector<PushTake> takes;
  try {
    for (const base::Json& json : list) {
      POISE_ASSIGN_OR_RETURN(PushTake take, ReadTake(file, takes.size(), json));
      takes.push_back(std::move(take));
    }
  } catch (const base::Json::exception& error) {
    return Malformed(what, error.what());
  }
  return takes;
}

}  // namespace poise::push
