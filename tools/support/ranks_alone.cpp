// SPDX-License-Identifier: BSD-3-Clause
#include "support/ranks.h"
#include "support/tool.h"
namespace fresco {
int runRanks(const std::string& name, int, char**,
             const std::function<void(const std::string& program, Exchange& ranks)>& body)
{
  Exchange alone;
  return runTool(name, [&] { body(name, alone); });
}
} // namespace fresco
