#include "client/cli/help_format.h"

#include <fmt/format.h>

#include <sstream>

namespace poise::cli {
namespace {

constexpr size_t kWidth = 96;

}  // namespace

std::string Wrap(std::string_view text, size_t width) {
  std::string wrapped;
  size_t column = 0;
  for (size_t begin = 0; begin < text.size();) {
    if (text[begin] == '\n') {
      wrapped += '\n';
      column = 0;
      ++begin;
      continue;
    }
    const size_t end = std::min(text.find_first_of(" \n", begin), text.size());
    const std::string_view word = text.substr(begin, end - begin);
    if (column > 0 && column + 1 + word.size() > width) {
      wrapped += '\n';
      column = 0;
    }
    if (column > 0) wrapped += ' ';
    wrapped += word;
    column += word.size() + (column > 0 ? 1 : 0);
    begin = end < text.size() && text[end] == ' ' ? end + 1 : end;
  }
  return wrapped;
}

std::string HelpFormat::make_description(const CLI::App* app) const {
  return Wrap(app->get_description(), kWidth) + "\n\n";
}

std::string HelpFormat::make_subcommand(const CLI::App* command) const {
  const std::string description = command->get_description();
  std::ostringstream out;
  CLI::detail::format_help(
      out, command->get_name(),
      Wrap(description.substr(0, description.find('\n')), kWidth - get_column_width()),
      get_column_width());
  return out.str();
}

std::string HelpFormat::make_option_opts(const CLI::Option* option) const {
  const bool takes_value = option->get_type_size() != 0;
  return takes_value && !option->get_type_name().empty() ? " " + option->get_type_name() : "";
}

std::string HelpFormat::make_option_desc(const CLI::Option* option) const {
  std::string description = option->get_description();
  const std::string default_value = option->get_default_str();
  if (!default_value.empty()) description += fmt::format(" (default: {})", default_value);
  return Wrap(description, kWidth - get_column_width());
}

}  // namespace poise::cli
