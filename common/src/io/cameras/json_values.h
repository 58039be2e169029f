// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include "io/files/expect.h"
#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
namespace fresco::io {
using Json = nlohmann::json;

/// @throws std::runtime_error
inline Json parsedJson(const std::string& content)
{
  Json json = Json::parse(content, nullptr, false);
  expect(json.is_object(), "truncated or damaged JSON: write it again");
  return json;
}

/// @throws std::runtime_error "`where` has no `key`"
inline const Json& memberOf(const Json& json, const char* key, const std::string& where)
{
  expect(json.is_object() && json.contains(key), where, " has no ", key, ": write it again");
  return json[key];
}

/// As many numbers, from lists within lists, too. @throws std::runtime_error naming `where`
template <int count>
Eigen::Matrix<double, count, 1> numbersOf(const Json& json, const std::string& where)
{
  Eigen::Matrix<double, count, 1> numbers;
  int found = 0;
  const auto add = [&](const Json& value) {
    if (value.is_number() && found < count)
      numbers[found] = value;
    found += value.is_number() ? 1 : count + 1;
  };
  for (const Json& row : json.is_array() ? json : Json::array({json}))
    if (row.is_array())
      for (const Json& value : row)
        add(value);
    else
      add(row);
  expect(found == count, where, " wants ", count, count == 1 ? " number" : " numbers");
  return numbers;
}

/// A whole number that is not negative: a key, or pixels.
inline std::int64_t wholeOf(const Json& json, const std::string& where)
{
  constexpr double most = 1LL << 53;
  const double value = numbersOf<1>(json, where)[0];
  expect(value >= 0 && value <= most, where, " is no whole number");
  return std::int64_t(value);
}

inline std::string stringOf(const Json& json, const std::string& where)
{
  expect(json.is_string(), where, " wants a text");
  return json;
}
} // namespace fresco::io
