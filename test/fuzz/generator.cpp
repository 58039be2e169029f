// SPDX-License-Identifier: BSD-3-Clause
#include "generator.h"
#include "dice.h"
namespace fresco::fuzz {
namespace {
const std::vector<std::string>& extremes()
{
  static const std::vector<std::string> all = {"0",
                                               "-1",
                                               "1",
                                               "255",
                                               "65536",
                                               "2147483647",
                                               "2147483648",
                                               "4294967295",
                                               "4294967296",
                                               "6148914691236517206",
                                               "9223372036854775807",
                                               "18446744073709551615",
                                               "1e300",
                                               "-1e300",
                                               "1e-300",
                                               "nan",
                                               "inf",
                                               "\"\"",
                                               "[]",
                                               "{}"};
  return all;
}

struct Span {
  std::size_t begin, end;
};

/// Where words, or numbers, of a text are.
std::vector<Span> wordsOf(const std::string& text, bool numbers)
{
  const auto belongs = [&](char c) {
    const bool digit = (c >= '0' && c <= '9') || c == '-' || c == '.';
    return numbers ? digit : c > ' ' && c != ',' && c != '/';
  };
  std::vector<Span> spans;
  for (std::size_t at = 0; at < text.size();) {
    const auto end =
        std::size_t(std::find_if_not(text.begin() + std::ptrdiff_t(at), text.end(), belongs) - text.begin());
    if (end > at)
      spans.push_back({at, end});
    at = end + 1;
  }
  return spans;
}

void replaceSpan(std::string& text, bool numbers, Dice& dice, const std::string& by)
{
  const std::vector<Span> spans = wordsOf(text, numbers);
  if (spans.empty())
    return;
  const Span span = dice.of(spans);
  text.replace(span.begin, span.end - span.begin, by);
}

/// A number of 1 to 8 bytes becomes another.
void overwrite(std::string& bytes, Dice& dice)
{
  const std::size_t width = std::size_t{1} << dice.below(4);
  if (bytes.size() < width)
    return;
  const std::uint64_t value =
      dice.of<std::uint64_t>({0, 1, 0x7fffffff, 0xffffffff, 0x100000000, ~std::uint64_t{0}, 1ULL << 62});
  const std::size_t at = std::size_t(dice.below(bytes.size() - width + 1));
  bytes.replace(at, width, raw(value).substr(0, width));
}
} // namespace

std::string GeneratedFile::packed() const
{
  std::string text;
  for (std::size_t i = 0; i + (kind == Kind::glb ? 1 : 0) < parts.size(); ++i)
    text += parts[i];
  if (const std::size_t xml = text.find("<?xml"); kind == Kind::e57 && xml != std::string::npos && xml >= 48)
    text.replace(24, 16, raw(std::uint64_t{xml / 1020 * 1024 + xml % 1020}) + raw(std::uint64_t{text.size() - xml}));
  if (kind != Kind::glb)
    return text;
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string buffer = parts.empty() ? "" : parts.back();
  buffer.resize((buffer.size() + 3) / 4 * 4, '\0');
  const auto total = std::uint32_t(28 + text.size() + buffer.size());
  return "glTF" + raw(std::uint32_t(2)) + raw(total) + raw(std::uint32_t(text.size())) + "JSON" + text +
         raw(std::uint32_t(buffer.size())) + std::string("BIN\0", 4) + buffer;
}

std::string broken(GeneratedFile file, std::uint32_t seed)
{
  Dice dice(seed);
  Parts& parts = file.parts;
  if (parts.empty())
    return "";
  const auto one = [&] { return std::size_t(dice.below(parts.size())); };
  const std::size_t at = one(), other = one();
  switch (dice.below(7)) {
  case 0:
    parts.erase(parts.begin() + std::ptrdiff_t(at));
    break;
  case 1:
    parts.insert(parts.begin() + std::ptrdiff_t(other), std::string(parts[at]));
    break;
  case 2:
    std::swap(parts[at], parts[other]);
    break;
  case 3:
    replaceSpan(parts[at], true, dice, dice.of(extremes()));
    break;
  case 4: {
    const std::vector<Span> words = wordsOf(parts[other], false);
    const Span word = words.empty() ? Span{0, 0} : dice.of(words);
    replaceSpan(parts[at], false, dice, parts[other].substr(word.begin, word.end - word.begin));
    break;
  }
  case 5:
    overwrite(parts[at], dice);
    break;
  default: { // many times the same: nesting, or a list without end
    const std::string part = parts[at];
    for (int i = dice.below(200); i > 0; --i)
      parts[at] += part;
    break;
  }
  }
  std::string bytes = file.packed();
  if (dice.below(8) == 0)
    bytes.resize(bytes.size() - std::size_t(dice.below(bytes.size() + 1)));
  return bytes;
}

std::string broken(std::string_view input, std::uint32_t seed)
{
  GeneratedFile file;
  while (!input.empty()) {
    const std::size_t end = std::min(input.find('\n'), input.size() - 1) + 1;
    file.parts.emplace_back(input.substr(0, end));
    input.remove_prefix(end);
  }
  return broken(std::move(file), seed);
}
} // namespace fresco::fuzz
