#include "core/engine/job_diagnosis.h"

#include <fmt/format.h>

#include <string>
#include <utility>

#include "core/artifacts/artifact_name.h"
#include "core/base/sha256.h"

namespace poise::engine {
namespace {

using jobs::Finding;
using Severity = Finding::Severity;

constexpr char kCheck[] = "artifacts";
constexpr int64_t kChunkBytes = 1 << 20;
constexpr size_t kMaxMessages = 10;

// What is wrong with an artifact; empty when nothing is. Read in pieces: it may be larger than the
// memory.
StatusOr<std::string> Fault(const artifacts::ArtifactStore& artifacts, const std::string& name,
                            const base::RunContext& context) {
  base::Sha256 digest;
  for (int64_t offset = 0;; offset += kChunkBytes) {
    POISE_RETURN_IF_ERROR(context.Check());
    const StatusOr<std::string> chunk = artifacts.Read(name, offset, kChunkBytes);
    if (!chunk.ok()) return base::Message(chunk.status());
    digest.Update(*chunk);
    if (static_cast<int64_t>(chunk->size()) < kChunkBytes) break;
  }
  if (artifacts::ArtifactName(digest.HexDigest()) == name) return std::string();
  return fmt::format("the content of {} is not what was stored", name);
}

}  // namespace

StatusOr<std::vector<Finding>> DiagnoseJobs(jobs::JobStore& store,
                                            const artifacts::ArtifactStore& artifacts,
                                            const base::RunContext& context) {
  POISE_ASSIGN_OR_RETURN(std::vector<Finding> findings, store.Diagnose());
  POISE_ASSIGN_OR_RETURN(const std::vector<std::string> names, store.ReferencedArtifacts());
  size_t faults = 0;
  for (const std::string& name : names) {
    POISE_ASSIGN_OR_RETURN(std::string fault, Fault(artifacts, name, context));
    if (fault.empty()) continue;
    if (++faults <= kMaxMessages) {
      findings.push_back({Severity::kFault, kCheck, std::move(fault)});
    }
  }
  if (faults > kMaxMessages) {
    findings.push_back(
        {Severity::kFault, kCheck, fmt::format("{} faults more", faults - kMaxMessages)});
  }
  if (faults == 0) {
    findings.push_back({Severity::kOk, kCheck,
                        fmt::format("{} artifacts of jobs are there and whole", names.size())});
  }
  return findings;
}

}  // namespace poise::engine
