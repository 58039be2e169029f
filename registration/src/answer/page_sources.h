// SPDX-License-Identifier: BSD-3-Clause
#pragma once
namespace fresco::registration {
extern const char* const page_js;  ///< content of page.js
extern const char* const page_css; ///< content of page.css
} // namespace fresco::registration
