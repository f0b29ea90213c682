#ifndef POISE_CLIENT_CLI_HELP_FORMAT_H_
#define POISE_CLIENT_CLI_HELP_FORMAT_H_

#include <string>
#include <string_view>

#include "CLI/CLI.hpp"

namespace poise::cli {

/// Breaks lines between words so that none is longer than `width`; line ends in `text` stay.
std::string Wrap(std::string_view text, size_t width);

/// How help looks: wrapped text, the first line of a description as the summary of a command, and
/// defaults in words.
class HelpFormat : public CLI::Formatter {
 public:
  HelpFormat() { column_width(24); }
  std::string make_description(const CLI::App* app) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_option_opts(const CLI::Option* option) const override;
  std::string make_option_desc(const CLI::Option* option) const override;
};

}  // namespace poise::cli

#endif  // POISE_CLIENT_CLI_HELP_FORMAT_H_
