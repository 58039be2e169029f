// SPDX-License-Identifier: BSD-3-Clause
#pragma once
namespace fresco::model {
extern const char* const viewer_js;  ///< content of viewer.js
extern const char* const viewer_css; ///< content of viewer.css
} // namespace fresco::model
