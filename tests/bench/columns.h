// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tests/bench/measure.h"

namespace camway::bench {

/// How a value is put into a table.
std::string plain(const nlohmann::json& value);  ///< strings and counts as they are
std::string as_duration(const nlohmann::json& seconds);
std::string as_ratio(const nlohmann::json& ratio);
std::string as_number(const nlohmann::json& value);
std::string as_tenths(const nlohmann::json& value);

/// One number of an `Item`, for the table and for JSON.
template <class Item>
struct Column {
  std::string pointer;  ///< where in the item's JSON object: "/seconds/camway"; empty: not there
  std::string title;    ///< of the table's column; empty: not there
  std::function<nlohmann::json(const Item&)> value;
  std::string (*text)(const nlohmann::json&) = plain;
};

/// The value of a column that is a member.
template <class Item, class Value>
std::function<nlohmann::json(const Item&)> field(Value Item::*member) {
  return [member](const Item& item) -> nlohmann::json { return item.*member; };
}

/// A row for each item.
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

/// An object for each item.
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
