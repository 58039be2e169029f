// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <string>
namespace fresco {
/// Text of a JSON value, a line more than its last one. Names of files may be of any bytes: what is no UTF-8 becomes
/// U+FFFD.
/// @param indent blanks per level; -1 = all in one line, without its end
template <typename Json>
std::string jsonText(const Json& json, int indent)
{
  return json.dump(indent, ' ', false, Json::error_handler_t::replace) + (indent < 0 ? "" : "\n");
}
} // namespace fresco
