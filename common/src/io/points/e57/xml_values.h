// SPDX-License-Identifier: BSD-3-Clause
#pragma once
#include <cstdint>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>
namespace fresco::io::e57 {
/// Values in the XML section of an E57 file (ASTM E2807-11, 7): the type stands in an attribute, no text is 0 or "".

std::string_view localName(pugi::xml_node node); ///< without the prefix of an extension

std::string_view prefixOf(pugi::xml_node node); ///< with the colon; "" = none

/// The child of that name and the prefix of `node`, since extensions may use names again; empty if there is none.
pugi::xml_node childNamed(pugi::xml_node node, std::string_view name);

/// For messages of one line: without control characters.
std::string singleLine(std::string text, std::size_t most = 60);

/// @throws std::runtime_error naming the element
std::string_view typeOf(pugi::xml_node node);
double realOf(pugi::xml_node node); ///< of a Float, Integer or ScaledInteger
std::int64_t integerOf(pugi::xml_node node);

/// A number of type double, std::int64_t or std::uint64_t. @param otherwise where it is missing; nothing: it must be there
/// @throws std::runtime_error naming the element and the attribute
template <typename T>
T attributeOf(pugi::xml_node node, const char* name, std::optional<T> otherwise = {});

/// Of the child of that name; nothing if it is missing.
std::optional<double> realIn(pugi::xml_node node, std::string_view name);
std::string textIn(pugi::xml_node node, std::string_view name);
} // namespace fresco::io::e57
