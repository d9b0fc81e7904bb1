// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "tests/bench/request_set.h"

/// Options and output that all benchmarks share.
namespace camway::bench {

void add_request_options(CLI::App& app, RequestSource& source);
/// `--set`, in place of the requests, the scene and the scale of `add_request_options`.
void add_set_option(CLI::App& app, std::vector<RequestSet>& sets);
void add_rounds_option(CLI::App& app, int& rounds);
void add_json_option(CLI::App& app, std::string& file);

/// Returns the begin of every document: the name of the benchmark and the machine.
nlohmann::json document_of(const std::string& benchmark);

/// Writes the document, if a file was named. Returns the exit code.
int finish(const nlohmann::json& document, const std::string& json_file);

}  // namespace camway::bench
