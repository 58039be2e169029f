// SPDX-License-Identifier: BSD-3-Clause
#include "io/points/e57/xml_values.h"
#include "io/points/text_numbers.h"
#include <algorithm>
namespace fresco::io::e57 {
namespace {
template <typename T>
T numberOf(const char* text, const std::string& where)
{
  const std::string_view word = trimmed(text);
  constexpr const char* wanted = std::is_floating_point_v<T> ? "number" : "whole number of 64 bits";
  return word.empty() ? T(0) : parseNumberOr<T>(word, "XML: ", where, ": '", singleLine(text), "' is no ", wanted);
}
} // namespace

std::string_view localName(pugi::xml_node node)
{
  const std::string_view name = node.name();
  const std::size_t colon = name.rfind(':');
  return colon == std::string_view::npos ? name : name.substr(colon + 1);
}

std::string_view prefixOf(pugi::xml_node node)
{
  const std::string_view name = node.name(), local = localName(node);
  return name.substr(0, name.size() - local.size());
}

pugi::xml_node childNamed(pugi::xml_node node, std::string_view name)
{
  return node.child(concat(prefixOf(node), name).c_str());
}

std::string_view typeOf(pugi::xml_node node)
{
  const pugi::xml_attribute type = node.attribute("type");
  expect(type, "XML: ", singleLine(node.name()), " has no type");
  return type.value();
}

std::int64_t integerOf(pugi::xml_node node)
{
  return numberOf<std::int64_t>(node.child_value(), singleLine(node.name()));
}

double realOf(pugi::xml_node node)
{
  if (typeOf(node) == "ScaledInteger")
    return double(integerOf(node)) * attributeOf<double>(node, "scale", 1) + attributeOf<double>(node, "offset", 0);
  return numberOf<double>(node.child_value(), singleLine(node.name()));
}

template <typename T>
T attributeOf(pugi::xml_node node, const char* name, std::optional<T> otherwise)
{
  const pugi::xml_attribute attribute = node.attribute(name);
  if (!attribute && otherwise)
    return *otherwise;
  expect(attribute, "XML: ", singleLine(node.name()), " has no ", name);
  return numberOf<T>(attribute.value(), concat(singleLine(node.name()), ' ', name));
}

template double attributeOf(pugi::xml_node, const char*, std::optional<double>);
template std::int64_t attributeOf(pugi::xml_node, const char*, std::optional<std::int64_t>);
template std::uint64_t attributeOf(pugi::xml_node, const char*, std::optional<std::uint64_t>);

std::optional<double> realIn(pugi::xml_node node, std::string_view name)
{
  const pugi::xml_node child = childNamed(node, name);
  return child ? std::optional(realOf(child)) : std::nullopt;
}

std::string singleLine(std::string text, std::size_t most)
{
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
  return text.substr(0, most);
}

std::string textIn(pugi::xml_node node, std::string_view name) { return childNamed(node, name).child_value(); }
} // namespace fresco::io::e57
