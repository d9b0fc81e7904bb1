// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/bench/measure.h"

namespace camway::bench {

/// Formats of values in a table.
std::string plain(const nlohmann::json& value);  ///< strings and counts, unchanged
std::string as_duration(const nlohmann::json& seconds);
std::string as_ratio(const nlohmann::json& ratio);
std::string as_number(const nlohmann::json& value);
std::string as_tenths(const nlohmann::json& value);
std::string as_share(const nlohmann::json& value);  ///< in percent

/// "1.2 / 3.4": two values, such as quantiles, in one column.
std::string as_numbers(const nlohmann::json& pair);
std::string as_durations(const nlohmann::json& pair);

/// A column: one value of each `Item`, for the table and for JSON.
template <class Item>
struct Column {
  std::string pointer;  ///< path in the item's JSON object: "/seconds/camway"; empty: left out
  std::string title;    ///< title of the table's column; empty: left out
  std::function<nlohmann::json(const Item&)> value;
  std::string (*text)(const nlohmann::json&) = plain;
};

/// Returns the value function of a column that shows a member.
template <class Item, class Value>
std::function<nlohmann::json(const Item&)> field(Value Item::*member) {
  return [member](const Item& item) -> nlohmann::json { return item.*member; };
}

/// Prints a row for each item.
template <class Item>
void print_table(const std::vector<Column<Item>>& columns, const std::vector<Item>& items) {
  std::vector<std::string> head;
  for (const Column<Item>& column : columns) {
    if (!column.title.empty()) head.push_back(column.title);
  }
  Table table(std::move(head));
  for (const Item& item : items) {
    std::vector<std::string> row;
    for (const Column<Item>& column : columns) {
      if (!column.title.empty()) row.push_back(column.text(column.value(item)));
    }
    table.add(std::move(row));
  }
  table.print();
}

/// Returns an object for each item.
template <class Item>
nlohmann::json to_json(const std::vector<Column<Item>>& columns, const std::vector<Item>& items) {
  nlohmann::json list = nlohmann::json::array();
  for (const Item& item : items) {
    nlohmann::json entry;
    for (const Column<Item>& column : columns) {
      if (column.pointer.empty()) continue;
      entry[nlohmann::json::json_pointer(column.pointer)] = column.value(item);
    }
    list.push_back(std::move(entry));
  }
  return list;
}

}  // namespace camway::bench
