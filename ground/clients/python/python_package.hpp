// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>

#include "ground/model/catalogue.hpp"

/// A mission's Python client from its descriptors: a package with runtime.py as it stands here, and a module
/// with a class for each subsystem. Whatever a descriptor says arrives as a string literal or a safe identifier.
namespace hirosco::ground {

struct PythonPackage {
  std::string name;  ///< "hirosco_MISSION": never the name of a module of Python's own
  std::map<std::string, std::string> files;  ///< text by file name
};
/// The same catalogue gives the same octets.
[[nodiscard]] PythonPackage python_package(const Catalogue& catalogue);

/// Identifiers of one scope of Python. A name that is taken or a keyword gets a number: "lambda_2".
class PythonNames {
 public:
  explicit PythonNames(std::set<std::string> taken) : taken_{std::move(taken)} {}
  /// "MOVE_TO" becomes "move_to". Never begins with an underscore, so it is never one of the client's own.
  [[nodiscard]] std::string variable(std::string_view name);
  /// "MOVE_TO" becomes "MoveTo".
  [[nodiscard]] std::string type(std::string_view name);

 private:
  [[nodiscard]] std::string unique(std::string name);
  std::set<std::string> taken_;
};

/// A string literal of Python in ASCII, whatever the octets are.
[[nodiscard]] std::string python_string(std::string_view text);

}  // namespace hirosco::ground
