// SPDX-License-Identifier: BSD-3-Clause
#include "support/args.h"
#include <cmath>
#include <cstdlib>
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

bool looksLikeOption(const std::string& word)
{
  return word.size() > 1 && word[0] == '-' && !std::isdigit(static_cast<unsigned char>(word[1])) && word[1] != '.';
}
} // namespace

Args::Args(std::string synopsis, std::string description)
    : synopsis_(std::move(synopsis)), description_(std::move(description))
{}

double Args::number(const std::string& name, const std::string& text)
{
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !std::isfinite(value))
    throw UsageError("option -" + name + " wants a number, not '" + text + "'");
  return value;
}

long long Args::integer(const std::string& name, const std::string& text)
{
  char* end = nullptr;
  errno = 0;
  const long long value = std::strtoll(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || errno != 0)
    throw UsageError("option -" + name + " wants a whole number, not '" + text + "'");
  return value;
}

void Args::values(const std::string& name, const std::string& placeholders, const std::string& help,
                  std::function<void(const std::vector<std::string>&)> apply)
{
  options_.push_back({name, placeholders, help, "", wordCount(placeholders), std::move(apply)});
}

void Args::option(const std::string& name, int& value, const std::string& help)
{
  values(name, "N", help, [name, &value](const auto& words) {
    const long long number = integer(name, words[0]);
    if (number < std::numeric_limits<int>::min() || number > std::numeric_limits<int>::max())
      throw UsageError("option -" + name + ": " + words[0] + " is too large");
    value = number;
  });
  options_.back().shown_default = shown(value);
}

void Args::option(const std::string& name, float& value, const std::string& help)
{
  values(name, "X", help, [name, &value](const auto& words) {
    const double given = number(name, words[0]);
    if (std::abs(given) > std::numeric_limits<float>::max())
      throw UsageError("option -" + name + ": " + words[0] + " is too large");
    value = given;
  });
  options_.back().shown_default = shown(value);
}

void Args::option(const std::string& name, double& value, const std::string& help)
{
  values(name, "X", help, [name, &value](const auto& words) { value = number(name, words[0]); });
  options_.back().shown_default = shown(value);
}

void Args::option(const std::string& name, std::string& value, const std::string& help)
{
  values(name, "TEXT", help, [&value](const auto& words) { value = words[0]; });
  options_.back().shown_default = value;
}

void Args::size(const std::string& name, int& width, int& height, const std::string& help)
{
  values(name, "WxH", help, [name, &width, &height](const auto& words) {
    constexpr int most = 65536;
    const std::size_t cross = words[0].find('x');
    if (cross == std::string::npos)
      throw UsageError("option -" + name + " wants WIDTHxHEIGHT, not '" + words[0] + "'");
    const long long w = integer(name, words[0].substr(0, cross)), h = integer(name, words[0].substr(cross + 1));
    if (w < 1 || h < 1 || w > most || h > most)
      throw UsageError("option -" + name + ": " + words[0] + " is not within 1x1 and 65536x65536");
    width = w;
    height = h;
  });
  options_.back().shown_default = shown(width) + "x" + shown(height);
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
    return at + 1 + option.count;
  }
  throw UsageError("unknown option " + words[at]);
}

std::vector<std::string> Args::parse(int argc, char** argv, std::size_t least, std::size_t most)
{
  const std::vector<std::string> words(argv + 1, argv + argc);
  for (const std::string& word : words)
    if (word == "-h" || word == "-help" || word == "--help") {
      std::cout << usage();
      throw HelpShown();
    }
  std::vector<std::string> files;
  for (std::size_t i = 0; i < words.size();) {
    if (looksLikeOption(words[i]))
      i = readOption(words, i);
    else
      files.push_back(words[i++]);
  }
  if (files.size() < least || files.size() > most)
    throw UsageError("got " + std::to_string(files.size()) + " file arguments; usage: " + synopsis_);
  return files;
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
    line(left, option.help + (option.shown_default.empty() ? "" : " (default " + option.shown_default + ")"));
  }
  line("-h", "this text");
  if (!notes_.empty())
    text << "\n" << notes_;
  return text.str();
}
} // namespace fresco
