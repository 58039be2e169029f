// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fresco/core/require.h>
#include <fresco/io/file.h>
#include <fresco/io/listed.h>
#include <fresco/registration/core/scan_registration.h>
#include <iomanip>
#include <numeric>
#include <sstream>
namespace fresco {
namespace {
struct Form {
  const char* name;
  HintKind kind;
  const char* usage;
};
constexpr Form forms[] = {
    {"link", HintKind::link, "link A B"},
    {"relative", HintKind::relative, "relative A B and 12 or 16 numbers (A from B, by rows) or TX TY TZ QX QY QZ QW"},
    {"near", HintKind::near, "near A X Y [Z] RADIUS"},
    {"choose", HintKind::choose, "choose A B NUMBER"},
    {"apart", HintKind::apart, "apart A B"},
    {"order", HintKind::order, "order"}};

// Letters to change, add or take away (Levenshtein 1966).
std::size_t distance(const std::string& a, const std::string& b)
{
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t(0));
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t before = row[0]++;
    for (std::size_t k = 0; k < b.size(); ++k)
      before = std::exchange(row[k + 1], std::min({row[k], row[k + 1], before - (a[i] == b[k] ? 1 : 0)}) + 1);
  }
  return row.back();
}

// Without folder, without extension, or whole.
bool isCalled(const std::string& name, const std::string& word)
{
  const std::filesystem::path path(name);
  return word == name || word == path.filename() || word == path.stem();
}

class Line {
public:
  Line(const std::string& text, std::string where, const std::vector<std::string>& names)
      : where_(std::move(where)), names_(names)
  {
    std::istringstream stream(text.substr(0, text.find('#')));
    for (std::string word; stream >> std::ws && stream.peek() != EOF; words_.push_back(word))
      stream.peek() == '"' ? stream >> std::quoted(word) : stream >> word;
  }

  bool empty() const { return words_.empty(); }
  RegistrationHint hint() const;

private:
  [[noreturn]] void fail(const std::string& reason) const { throw std::runtime_error(where_ + ": " + reason); }
  Index scan(std::size_t word) const;
  std::vector<double> numbers(std::size_t first) const;
  Eigen::Matrix4d pose(const std::vector<double>& numbers) const;
  void readNear(const std::vector<double>& numbers, RegistrationHint& hint) const;

  std::string where_;
  const std::vector<std::string>& names_;
  std::vector<std::string> words_;
};

Index Line::scan(std::size_t word) const
{
  constexpr std::size_t most_told = 3;
  const std::string& wanted = words_[word];
  std::vector<Index> found;
  for (std::size_t k = 0; k < names_.size(); ++k)
    if (isCalled(names_[k], wanted))
      found.push_back(k);
  const auto exact = std::find(names_.begin(), names_.end(), wanted);
  if (exact != names_.end())
    return exact - names_.begin();
  if (found.size() == 1)
    return found[0];
  std::vector<std::string> nearest;
  for (const std::string& name : names_)
    nearest.push_back(std::filesystem::path(name).filename());
  std::stable_sort(nearest.begin(), nearest.end(), [&](const std::string& x, const std::string& y) {
    return distance(x, wanted) < distance(y, wanted);
  });
  nearest.resize(std::min(most_told, nearest.size()));
  fail(concat(found.empty() ? "no scan is called " : "several scans are called ", wanted, "; there are ",
              listed(nearest, most_told)));
}

std::vector<double> Line::numbers(std::size_t first) const
{
  std::vector<double> values;
  for (std::size_t k = first; k < words_.size(); ++k) {
    double value = 0.0;
    const std::string& word = words_[k];
    const auto read = std::from_chars(word.data(), word.data() + word.size(), value);
    if (read.ec != std::errc() || read.ptr != word.data() + word.size() || !std::isfinite(value))
      fail(word + " is no number");
    values.push_back(value);
  }
  return values;
}

Eigen::Matrix4d Line::pose(const std::vector<double>& numbers) const
{
  constexpr double tolerance = 1e-3; // of matrices and quaternions, as of poses.txt
  Eigen::Matrix4d T = Eigen::Matrix4d::Identity();
  if (numbers.size() == 7) {
    const Eigen::Quaterniond q(numbers[6], numbers[3], numbers[4], numbers[5]);
    if (!(std::abs(q.norm() - 1.0) <= tolerance))
      fail("QX QY QZ QW is no unit quaternion");
    T.topLeftCorner<3, 3>() = q.normalized().toRotationMatrix();
    T.topRightCorner<3, 1>() << numbers[0], numbers[1], numbers[2];
  } else {
    for (std::size_t k = 0; k < numbers.size(); ++k)
      T(k / 4, k % 4) = numbers[k];
  }
  if (!isRigid(T, tolerance))
    fail("not a rigid transform");
  return T;
}

void Line::readNear(const std::vector<double>& numbers, RegistrationHint& hint) const
{
  hint.any_height = numbers.size() == 3;
  hint.place << numbers[0], numbers[1], hint.any_height ? 0.0 : numbers[2];
  hint.radius = numbers.back();
  if (!(hint.radius > 0.0) || !isInReach(hint.place))
    fail("RADIUS is not above 0, or the place is too far away");
}

RegistrationHint Line::hint() const
{
  const Form* form =
      std::find_if(std::begin(forms), std::end(forms), [&](const Form& f) { return f.name == words_[0]; });
  if (form == std::end(forms))
    fail("no hint is called " + words_[0] + "; there are link, relative, near, choose, apart, order");
  RegistrationHint hint;
  hint.kind = form->kind;
  hint.source = where_;
  const std::size_t scans = hint.kind == HintKind::order ? 0 : hint.kind == HintKind::near ? 1 : 2;
  if (words_.size() < 1 + scans)
    fail(concat("wants ", form->usage));
  hint.a = scans > 0 ? scan(1) : 0;
  hint.b = scans > 1 ? scan(2) : 0;
  const std::vector<double> values = numbers(1 + scans);
  const std::size_t n = values.size();
  const bool fits = hint.kind == HintKind::relative ? n == 7 || n == 12 || n == 16
                    : hint.kind == HintKind::near   ? n == 3 || n == 4
                                                    : n == (hint.kind == HintKind::choose ? 1 : 0);
  if (!fits)
    fail(concat("wants ", form->usage));
  if (scans == 2 && hint.a == hint.b)
    fail("names the same scan twice");
  if (hint.kind == HintKind::relative)
    hint.T_a_b = pose(values);
  if (hint.kind == HintKind::near)
    readNear(values, hint);
  if (hint.kind == HintKind::choose) {
    if (!(values[0] >= 1.0 && values[0] == std::floor(values[0]) && values[0] < 1e6))
      fail("NUMBER counts from 1");
    hint.number = std::lround(values[0]);
  }
  return hint;
}
} // namespace

std::vector<RegistrationHint> readHints(const std::string& path, const std::vector<std::string>& names)
{
  std::istringstream content(readFile(path));
  std::vector<RegistrationHint> hints;
  int number = 0;
  for (std::string text; std::getline(content, text);) {
    const Line line(text, concat(path, ": line ", ++number), names);
    if (!line.empty())
      hints.push_back(line.hint());
  }
  return hints;
}
} // namespace fresco
