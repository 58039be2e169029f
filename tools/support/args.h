// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <fresco/io/range.h>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>
namespace fresco {
/// Wrong usage: the tool exits with 2.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// `-h` or `--version` was given: usage() or versionLine() has been printed, the tool exits with 0.
struct HelpShown {};

/// Command line in the style of PCL's tools: `fresco_x INPUT OUTPUT -option value`, parsed strictly: an unknown option,
/// a missing or malformed value or a wrong number of files is a UsageError. Negative numbers are values, not options. All
/// that follows `--` are files.
class Args {
public:
  /// @param synopsis    "fresco_filter IN OUT [options]"
  /// @param description what the tool does, one or more lines
  Args(std::string synopsis, std::string description);

  /// Declares `-name value`; what is given replaces what the variable holds, which the help shows as the default.
  /// @param range beyond it a value is a UsageError; the help shows it behind `help`. A default outside of it stands for
  ///        "not given". Beyond 1e12 and within 1e-12 of 0 no number is allowed
  /// @param help what it is, and its unit
  void option(const std::string& name, int& value, const Range& range, const std::string& help);
  void option(const std::string& name, float& value, const Range& range, const std::string& help);
  void option(const std::string& name, double& value, const Range& range, const std::string& help);
  void option(const std::string& name, std::string& value, const std::string& help);
  /// `-name A B C`: as many numbers as `placeholders` has words, each within `range`.
  void numbers(const std::string& name, const std::string& placeholders, const Range& range, const std::string& help,
               std::function<void(const std::vector<double>&)> apply);
  /// `-name WxH`: width and height of a picture.
  void size(const std::string& name, int& width, int& height, const Range& range, const std::string& help);
  /// `-name` without a value sets what is `given`.
  void flag(const std::string& name, bool& value, const std::string& help, bool given = true);
  /// `-name A B C`: exactly as many values as `placeholders` has words; `apply` gets them and may throw UsageError.
  void values(const std::string& name, const std::string& placeholders, const std::string& help,
              std::function<void(const std::vector<std::string>&)> apply);

  /// `-STAGE.NAME VALUE` for names that are not declared: `apply` gets name and value.
  void dotted(const std::string& help, std::function<void(const std::string& name, const std::string& value)> apply);
  /// `-name FILE` reads options from a file: lines "NAME VALUE...", '#' begins a comment. What stands behind it on the command
  /// line comes after it.
  void settingsFile(const std::string& name, const std::string& help);
  /// The options that were given, as such a file has them, but for those named.
  std::string settings(const std::vector<std::string>& without) const;

  /// Text printed at the end of the help (examples).
  void note(const std::string& text) { notes_ += text + "\n"; }

  /// @return the words that belong to no option: the files
  /// @throws UsageError, HelpShown
  std::vector<std::string> parse(int argc, char** argv, std::size_t least, std::size_t most);
  std::vector<std::string> parse(int argc, char** argv, std::size_t files) { return parse(argc, argv, files, files); }

  bool given(const std::string& name) const; ///< whether the option stood on the command line
  std::string usage() const;

  /// @throws UsageError, also unless 0 or of magnitude 1e-12..1e12
  static double number(const std::string& name, const std::string& text, const Range& range);
  static int integer(const std::string& name, const std::string& text, const Range& range);

private:
  struct Option {
    std::string name, placeholders, help, remark; ///< remark: in parentheses behind the help
    std::size_t count;
    std::function<void(const std::vector<std::string>&)> apply;
    bool given = false;
    std::string words = {}; ///< that were given last
  };
  std::size_t readOption(const std::vector<std::string>& words, std::size_t at);
  void readSettings(const std::string& path);
  std::function<void(const std::string&, const std::string&)> apply_dotted_;
  std::vector<std::pair<std::string, std::string>> given_dotted_;
  std::string synopsis_, description_, notes_;
  std::vector<Option> options_;
};

/// Refuses outputs that are the same file as another or as an input, by whatever names; empty names are none.
/// @throws UsageError naming the output
void requireDistinct(std::vector<std::string> outputs, const std::vector<std::string>& inputs);
} // namespace fresco
