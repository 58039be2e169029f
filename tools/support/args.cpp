// SPDX-License-Identifier: BSD-3-Clause
#include "support/args.h"
#include "support/option_names.h"
#include "support/version.h"
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <iomanip>
#include <iostream>
#include <limits>
#include <sstream>
namespace fresco {
namespace {
std::size_t wordCount(const std::string& text)
{
  std::istringstream stream(text);
  std::string word;
  std::size_t count = 0;
  while (stream >> word)
    ++count;
  return count;
}

template <typename T>
std::string shown(const T& value)
{
  std::ostringstream text;
  text << value;
  return text.str();
}

/// Numbers that any option may hold, besides 0: their squares and ratios are far from the ends of floating point.
constexpr double least_magnitude = 1e-12, most_magnitude = 1e12;

void requireInRange(const std::string& name, double value, const std::string& word, const Range& range)
{
  if (!range.holds(value))
    throw UsageError(concat("option -", name, ": ", word, " is out of range: ", range.text()));
}

/// A default that may not be given stands for "not given", and is not shown.
template <typename T>
std::string remarkOf(const Range& range, T value)
{
  const std::string text = shown(value); // 0.1, not what a float makes of it
  return range.text() + (range.holds(std::stod(text)) && std::isfinite(value) ? "; default " + text : "");
}

bool isSameFile(const std::string& a, const std::string& b)
{
  std::error_code error;
  if (std::filesystem::equivalent(a, b, error))
    return true;
  const auto place = [&](const std::string& path) {
    const std::filesystem::path canonical = std::filesystem::weakly_canonical(path, error);
    return error ? std::filesystem::path(path) : canonical;
  };
  return place(a) == place(b);
}

bool looksLikeOption(const std::string& word)
{
  return word.size() > 1 && word[0] == '-' && !std::isdigit(static_cast<unsigned char>(word[1])) && word[1] != '.';
}
} // namespace

Args::Args(std::string synopsis, std::string description)
    : synopsis_(std::move(synopsis)), description_(std::move(description))
{}

double Args::number(const std::string& name, const std::string& text, const Range& range)
{
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value))
    throw UsageError("option -" + name + " wants a number, not '" + text + "'");
  if (value != 0 && !(std::abs(value) >= least_magnitude && std::abs(value) <= most_magnitude))
    throw UsageError(concat("option -", name, ": ", text, " is out of range: 0, or of magnitude ", least_magnitude,
                            "..", most_magnitude));
  requireInRange(name, value, text, range);
  return value;
}

int Args::integer(const std::string& name, const std::string& text, const Range& range)
{
  char* end = nullptr;
  errno = 0;
  const long long value = std::strtoll(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || errno != 0)
    throw UsageError("option -" + name + " wants a whole number, not '" + text + "'");
  requireInRange(name, value, text, range);
  if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max())
    throw UsageError("option -" + name + ": " + text + " is too large");
  return static_cast<int>(value);
}

void Args::values(const std::string& name, const std::string& placeholders, const std::string& help,
                  std::function<void(const std::vector<std::string>&)> apply)
{
  options_.push_back({name, placeholders, help, "", wordCount(placeholders), std::move(apply)});
}

void Args::numbers(const std::string& name, const std::string& placeholders, const Range& range,
                   const std::string& help, std::function<void(const std::vector<double>&)> apply)
{
  values(name, placeholders, help, [name, range, apply = std::move(apply)](const std::vector<std::string>& words) {
    std::vector<double> given;
    for (const std::string& word : words)
      given.push_back(number(name, word, range));
    apply(given);
  });
  options_.back().remark = range.text();
}

void Args::option(const std::string& name, int& value, const Range& range, const std::string& help)
{
  values(name, "N", help, [name, range, &value](const auto& words) { value = integer(name, words[0], range); });
  options_.back().remark = remarkOf(range, value);
}

void Args::option(const std::string& name, float& value, const Range& range, const std::string& help)
{
  numbers(name, "X", range, help, [&value](const auto& given) { value = static_cast<float>(given[0]); });
  options_.back().remark = remarkOf(range, value);
}

void Args::option(const std::string& name, double& value, const Range& range, const std::string& help)
{
  numbers(name, "X", range, help, [&value](const auto& given) { value = given[0]; });
  options_.back().remark = remarkOf(range, value);
}

void Args::option(const std::string& name, std::string& value, const std::string& help)
{
  values(name, "TEXT", help, [&value](const auto& words) { value = words[0]; });
  options_.back().remark = value.empty() ? "" : "default " + value;
}

void Args::size(const std::string& name, int& width, int& height, const Range& range, const std::string& help)
{
  values(name, "WxH", help, [name, range, &width, &height](const auto& words) {
    const std::size_t cross = words[0].find('x');
    if (cross == std::string::npos)
      throw UsageError("option -" + name + " wants WIDTHxHEIGHT, not '" + words[0] + "'");
    width = integer(name, words[0].substr(0, cross), range);
    height = integer(name, words[0].substr(cross + 1), range);
  });
  options_.back().remark = concat(range.text(), " each; default ", width, "x", height);
}

void Args::flag(const std::string& name, bool& value, const std::string& help, bool given)
{
  values(name, "", help, [&value, given](const auto&) { value = given; });
}

bool Args::given(const std::string& name) const
{
  for (const Option& option : options_)
    if (option.name == name)
      return option.given;
  return false;
}

std::size_t Args::readOption(const std::vector<std::string>& words, std::size_t at)
{
  const std::string name = words[at].substr(words[at].rfind("--", 0) == 0 ? 2 : 1);
  for (Option& option : options_) {
    if (option.name != name)
      continue;
    if (at + option.count >= words.size())
      throw UsageError("option -" + name + " wants " + option.placeholders);
    const auto first = words.begin() + at + 1;
    const std::vector<std::string> given(first, first + option.count);
    for (const std::string& word : given)
      if (looksLikeOption(word))
        throw UsageError("option -" + name + " wants " + option.placeholders + ", not '" + word + "'");
    option.apply(given);
    option.given = true;
    option.words.clear();
    for (const std::string& word : given)
      option.words += " " + word;
    return at + 1 + option.count;
  }
  if (apply_dotted_ && name.find('.') != std::string::npos) {
    if (at + 1 >= words.size() || looksLikeOption(words[at + 1]))
      throw UsageError("option -" + name + " wants a value");
    apply_dotted_(name, words[at + 1]);
    given_dotted_.emplace_back(name, words[at + 1]);
    return at + 2;
  }
  std::vector<std::string> known;
  for (const Option& option : options_)
    known.push_back(option.name);
  throw UsageError("unknown option " + words[at] + meantOption(name, known));
}

void Args::dotted(const std::string& help, std::function<void(const std::string&, const std::string&)> apply)
{
  apply_dotted_ = std::move(apply);
  notes_ += help + "\n";
}

void Args::settingsFile(const std::string& name, const std::string& help)
{
  values(name, "FILE", help, [this](const auto& words) { readSettings(words[0]); });
}

void Args::readSettings(const std::string& path)
{
  std::istringstream lines(readFile(path));
  for (std::string line; std::getline(lines, line);) {
    std::istringstream text(line.substr(0, line.find('#')));
    std::vector<std::string> words;
    for (std::string word; text >> word;)
      words.push_back(words.empty() ? "-" + word : word);
    try {
      if (!words.empty() && readOption(words, 0) != words.size())
        throw UsageError("too many values: " + line);
    } catch (const UsageError& error) {
      throw UsageError(path + ": " + error.what());
    }
  }
}

std::string Args::settings(const std::vector<std::string>& without) const
{
  std::string text;
  for (const Option& option : options_)
    if (option.given && std::find(without.begin(), without.end(), option.name) == without.end())
      text += option.name + option.words + "\n";
  for (const auto& [name, value] : given_dotted_)
    text += name + " " + value + "\n";
  return text;
}

std::vector<std::string> Args::parse(int argc, char** argv, std::size_t least, std::size_t most)
{
  const std::vector<std::string> words(argv + 1, argv + argc);
  const auto end_of_options = std::find(words.begin(), words.end(), "--");
  for (auto word = words.begin(); word != end_of_options; ++word) {
    const bool is_help = *word == "-h" || *word == "-help" || *word == "--help";
    if (is_help || *word == "--version") {
      std::cout << (is_help ? usage() : versionLine() + "\n");
      throw HelpShown();
    }
  }
  std::vector<std::string> files;
  for (std::size_t i = 0; i < words.size();) {
    if (words[i] == "--") { // all that follow are files, whatever they begin with
      files.insert(files.end(), words.begin() + i + 1, words.end());
      break;
    }
    if (looksLikeOption(words[i]))
      i = readOption(words, i);
    else
      files.push_back(words[i++]);
  }
  if (files.size() < least || files.size() > most)
    throw UsageError("got " + std::to_string(files.size()) + " file arguments; usage: " + synopsis_);
  return files;
}

void requireDistinct(std::vector<std::string> outputs, const std::vector<std::string>& inputs)
{
  outputs.erase(std::remove(outputs.begin(), outputs.end(), ""), outputs.end());
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k)
      if (isSameFile(outputs[k], outputs[i]))
        throw UsageError(outputs[i] + ": two outputs go to this file");
    for (const std::string& input : inputs)
      if (!input.empty() && isSameFile(input, outputs[i]))
        throw UsageError(outputs[i] + ": the output is an input, too");
  }
}

std::string Args::usage() const
{
  std::ostringstream text;
  text << "usage: " << synopsis_ << "\n\n" << description_ << "\n\noptions:\n";
  const auto line = [&](const std::string& left, const std::string& right) {
    text << "  " << std::left << std::setw(26) << left << (left.size() >= 26 ? "\n" + std::string(28, ' ') : "")
         << right << "\n";
  };
  for (const Option& option : options_) {
    const std::string left = "-" + option.name + (option.placeholders.empty() ? "" : " " + option.placeholders);
    line(left, option.help + (option.remark.empty() ? "" : " (" + option.remark + ")"));
  }
  line("-h", "this text");
  line("--version", "version of fresco and of the libraries that this tool loads");
  if (!notes_.empty())
    text << "\n" << notes_;
  return text.str();
}
} // namespace fresco
