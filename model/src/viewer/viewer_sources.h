// SPDX-License-Identifier: BSD-3-Clause
#pragma once
namespace fresco::model {
extern const char* const viewer_js;  ///< the function frescoViewer(), of all files of the viewer
extern const char* const viewer_css; ///< content of viewer.css
extern const char* const page_css;   ///< content of page.css
} // namespace fresco::model
