#include <fmt/format.h>

#include <memory>

#include "absl/time/clock.h"
#include "client/cli/commands.h"
#include "client/cli/jobs/job_options.h"
#include "client/client.h"

namespace poise::cli {
namespace {

constexpr char kDescription[] =
    "For operators: look after a server's store of jobs.\n\n"
    "doctor checks it, backup copies it while it is in use.";
constexpr char kFooter[] =
    "Examples:\n"
    "  poise admin doctor\n"
    "  poise admin backup backups/monday.db";

constexpr char kDoctorDescription[] =
    "Check the store of jobs, and the files that its jobs name.\n\n"
    "Exit code 1 when there is a fault; warnings alone are 0.";
constexpr char kDoctorFooter[] =
    "Examples:\n"
    "  poise admin doctor\n"
    "  poise admin doctor --json | jq '.findings[] | select(.severity != \"OK\")'";

constexpr char kBackUpDescription[] =
    "Copy the store of jobs, while it is in use, to a file on the server's machine.\n\n"
    "The path lies below the server's data folder and must not exist yet. The files of the jobs "
    "(artifacts/ in the data folder) never change and can be copied by any tool, after this.";
constexpr char kBackUpFooter[] =
    "Examples:\n"
    "  poise admin backup\n"
    "  poise admin backup backups/monday.db --json";

struct AdminOptions {
  client::ClientOptions connection = client::ClientOptions::FromEnvironment();
  std::string path;
};

const char* SeverityName(client::Finding::Severity severity) {
  switch (severity) {
    case client::Finding::Severity::kOk:
      return "OK";
    case client::Finding::Severity::kWarning:
      return "WARNING";
    default:
      return "FAULT";
  }
}

Status RunDoctor(const AdminOptions& options, const Console& console) {
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_ASSIGN_OR_RETURN(const std::vector<client::Finding> findings, client->Doctor());
  base::Json json = base::Json::array();
  int faults = 0;
  for (const client::Finding& finding : findings) {
    const char* severity = SeverityName(finding.severity);
    json.push_back(
        {{"severity", severity}, {"check", finding.check}, {"message", finding.message}});
    if (finding.severity == client::Finding::Severity::kFault) ++faults;
    if (!console.json()) {
      console.Print(fmt::format("{:<8} {:<10}  {}", severity, finding.check, finding.message));
    }
  }
  if (console.json()) console.PrintJson({{"findings", std::move(json)}});
  if (faults == 0) return absl::OkStatus();
  return base::MakeError(absl::StatusCode::kDataLoss, "STORE_FAULTY", "",
                         fmt::format("{} of {} checks found a fault", faults, findings.size()));
}

Status RunBackUp(const AdminOptions& options, const Console& console) {
  std::string path = options.path;
  if (path.empty()) {
    path = absl::FormatTime("backups/%Y%m%d-%H%M%S.db", absl::Now(), absl::UTCTimeZone());
  }
  POISE_ASSIGN_OR_RETURN(const auto client, client::Client::Connect(options.connection));
  POISE_ASSIGN_OR_RETURN(const client::StoreBackup backup, client->BackUp(path));
  if (console.json()) {
    console.PrintJson({{"path", backup.path}, {"size_bytes", backup.size_bytes}});
  } else {
    console.Print(fmt::format("{}, {} bytes", backup.path, backup.size_bytes));
  }
  return absl::OkStatus();
}

}  // namespace

std::vector<Command> AddAdminCommands(CLI::App& app, const Console& console) {
  CLI::App* admin = app.add_subcommand("admin", kDescription);
  admin->footer(kFooter);
  auto options = std::make_shared<AdminOptions>();
  CLI::App* doctor = admin->add_subcommand("doctor", kDoctorDescription);
  doctor->footer(kDoctorFooter);
  AddConnectionFlags(*doctor, options->connection);
  CLI::App* backup = admin->add_subcommand("backup", kBackUpDescription);
  backup->footer(kBackUpFooter);
  backup->add_option("PATH", options->path, "Default: backups/<time>.db")->type_name("");
  AddConnectionFlags(*backup, options->connection);
  return {{doctor, [options, &console] { return RunDoctor(*options, console); }},
          {backup, [options, &console] { return RunBackUp(*options, console); }}};
}

}  // namespace poise::cli
