// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>

#include "ground/model/catalogue.hpp"

/// A mission's Python client from its descriptors: a package with runtime.py as it stands here, and a module
/// with a class for each subsystem.
namespace hirosco::ground {

struct PythonPackage {
  std::string name;  ///< "hirosco_MISSION": never the name of a module of Python's own
  std::map<std::string, std::string> files;  ///< text by file name
};
/// The same catalogue gives the same octets.
[[nodiscard]] PythonPackage python_package(const Catalogue& catalogue);

}  // namespace hirosco::ground
