// SPDX-License-Identifier: BSD-3-Clause
#include "io/files/remarks.h"
#include <algorithm>
#include <fresco/core/point_table.h>
#include <mutex>
namespace fresco {
namespace {
struct Reading {
  std::mutex mutex;
  ReadingListener listener;
  std::vector<std::string> columns;
};

Reading& reading()
{
  static auto* const shared = new Reading;
  return *shared;
}

thread_local const std::string* in_hand = nullptr;
} // namespace

void listenToReaders(ReadingListener listener)
{
  const std::lock_guard<std::mutex> lock(reading().mutex);
  reading().listener = std::move(listener);
}

void setTextColumns(const std::vector<std::string>& names)
{
  std::vector<std::string> columns;
  for (const std::string& name : names)
    columns.push_back(name == "-" ? "" : core::standardName(name));
  for (const char* axis : core::xyz_names)
    require(names.empty() || std::count(columns.begin(), columns.end(), axis) == 1, "columns: wants ", axis, " once");
  const std::lock_guard<std::mutex> lock(reading().mutex);
  reading().columns = columns;
}

io::FileInHand::FileInHand(const std::string& path) : outer_(in_hand) { in_hand = &path; }
io::FileInHand::~FileInHand() { in_hand = outer_; }

void io::remark(const std::string& text)
{
  ReadingListener listener;
  {
    const std::lock_guard<std::mutex> lock(reading().mutex);
    listener = reading().listener;
  }
  if (listener)
    listener(in_hand ? *in_hand + ": " + text : text);
}

std::vector<std::string> textColumns()
{
  const std::lock_guard<std::mutex> lock(reading().mutex);
  return reading().columns;
}
} // namespace fresco
