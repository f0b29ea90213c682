#include "core/runtime/jobs/child_message.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/base/json.h"
#include "core/runtime/jobs/job_json.h"

namespace poise::jobs {
namespace {

using base::Json;

Status BadLine(std::string_view what) {
  return base::Internal("CHILD_PROTOCOL", fmt::format("a line of the child process {}", what));
}

// Calls `read` on the parsed line.
template <typename Value, typename Read>
StatusOr<Value> Parse(std::string_view line, Read read) {
  const StatusOr<Json> json = base::ParseJson(line, "line");
  if (!json.ok()) return BadLine("is no JSON");
  try {
    return read(*json);
  } catch (const Json::exception& error) {
    return BadLine(fmt::format("has another form than expected: {}", error.what()));
  }
}

Json OutputToJson(const RunOutput& output) {
  Json files = Json::array();
  for (const OutputFile& file : output.files) {
    files.push_back(
        {{"name", file.name}, {"path", file.path.string()}, {"media_type", file.media_type}});
  }
  return {{"files", std::move(files)}, {"report", output.report}};
}

RunOutput OutputFromJson(const Json& json) {
  RunOutput output;
  output.report = json.at("report");
  for (const Json& file : json.at("files")) {
    output.files.push_back({.name = file.at("name").get<std::string>(),
                            .path = file.at("path").get<std::string>(),
                            .media_type = file.at("media_type").get<std::string>()});
  }
  return output;
}

Json InputsToJson(const std::map<std::string, std::filesystem::path>& inputs) {
  Json json = Json::object();
  for (const auto& [artifact, path] : inputs) json[artifact] = path.string();
  return json;
}

std::string Line(const Json& json) { return ToJson(json) + "\n"; }

struct Encoder {
  std::string operator()(const base::Progress& progress) const {
    return fmt::format("{{\"progress\":{}}}\n", ToJson(progress));
  }
  std::string operator()(const ChildCheckpoint& checkpoint) const {
    return Line({{"checkpoint", {{"file", checkpoint.file.string()}, {"step", checkpoint.step}}}});
  }
  std::string operator()(const RunOutput& output) const {
    return Line({{"result", OutputToJson(output)}});
  }
  std::string operator()(const api::JobError& error) const {
    return fmt::format("{{\"error\":{}}}\n", ToJson(error));
  }
};

StatusOr<ChildMessage> MessageFromJson(const Json& json) {
  if (json.contains("progress")) return ParseProgress(json["progress"].dump());
  if (json.contains("error")) return ParseError(json["error"].dump());
  if (json.contains("result")) return OutputFromJson(json["result"]);
  const Json& checkpoint = json.at("checkpoint");
  return ChildCheckpoint{.file = checkpoint.at("file").get<std::string>(),
                         .step = base::IntegerFrom<int64_t>(checkpoint.at("step"))};
}

}  // namespace

std::string EncodeLine(const ChildStart& start) {
  const RunInput& input = start.input;
  Json json = {{"job", input.job},
               {"attempt", input.attempt},
               {"kind", input.spec.kind},
               {"parameters", input.spec.parameters},
               {"seed", input.seed},
               {"trace_id", input.trace_id},
               {"folder", input.folder.string()},
               {"inputs", InputsToJson(input.inputs)},
               {"checkpoint_file", start.checkpoint_file.string()},
               {"checkpoint_step", input.checkpoint_step},
               {"checkpoint_interval_s", absl::ToDoubleSeconds(start.checkpoint_interval)}};
  if (start.deadline_in < absl::InfiniteDuration()) {
    json["deadline_in_s"] = absl::ToDoubleSeconds(start.deadline_in);
  }
  return Line(json);
}

StatusOr<ChildStart> DecodeStart(std::string_view line) {
  return Parse<ChildStart>(line, [](const Json& json) {
    ChildStart start;
    RunInput& input = start.input;
    input.job = json.at("job").get<std::string>();
    input.attempt = base::IntegerFrom<int>(json.at("attempt"));
    input.spec.kind = json.at("kind").get<std::string>();
    input.spec.parameters = json.at("parameters");
    input.seed = base::IntegerFrom<uint64_t>(json.at("seed"));
    input.trace_id = json.at("trace_id").get<std::string>();
    input.folder = json.at("folder").get<std::string>();
    for (const auto& [artifact, path] : json.at("inputs").items()) {
      input.inputs[artifact] = path.get<std::string>();
    }
    input.checkpoint_step = base::IntegerFrom<int64_t>(json.at("checkpoint_step"));
    start.checkpoint_file = json.at("checkpoint_file").get<std::string>();
    start.checkpoint_interval = absl::Seconds(json.at("checkpoint_interval_s").get<double>());
    if (json.contains("deadline_in_s")) {
      start.deadline_in = absl::Seconds(json["deadline_in_s"].get<double>());
    }
    return start;
  });
}

std::string EncodeLine(const ChildMessage& message) { return std::visit(Encoder(), message); }

StatusOr<ChildMessage> DecodeMessage(std::string_view line) {
  StatusOr<ChildMessage> message = Parse<ChildMessage>(line, MessageFromJson);
  // The parts that a store keeps too have that store's errors.
  if (!message.ok()) return BadLine(base::Message(message.status()));
  return message;
}

void LineBuffer::Append(std::string_view bytes) {
  searched_ -= std::min(searched_, begin_);
  bytes_.erase(0, std::exchange(begin_, 0));
  bytes_.append(bytes);
}

std::optional<std::string> LineBuffer::Next() {
  const size_t end = bytes_.find('\n', std::max(searched_, begin_));
  const size_t length = std::min(end, bytes_.size()) - begin_;
  if (length > max_line_bytes_) {
    begin_ += max_line_bytes_;
    return bytes_.substr(begin_ - max_line_bytes_, max_line_bytes_);
  }
  if (end == std::string::npos) {
    searched_ = bytes_.size();
    return std::nullopt;
  }
  return bytes_.substr(std::exchange(begin_, end + 1), length);
}

std::string LineBuffer::Rest() { return bytes_.substr(std::exchange(begin_, bytes_.size())); }

}  // namespace poise::jobs
