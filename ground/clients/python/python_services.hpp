// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "ground/clients/python/python_text.hpp"
#include "ground/model/catalogue.hpp"

/// What the framework's services take and tell, in Python, from their own tables (docs/adr/0225): a further service needs no
/// row here.
namespace hirosco::ground {

/// The tables of a module that all its classes share: `_st3`, `_st5`, ... with requests, and `_told` with reports. Those which
/// only the supervisor may ask are not among them, nor what the client reads by other tables.
[[nodiscard]] std::string service_tables();

struct ServiceMethods {
  std::string tables;  ///< "*_st3, *_st5, ": the requests that the subsystem takes
  std::string methods;  ///< of its class
};
/// Of what the subsystem offers in any configuration, and the supervisor besides alone. Requests with words are not among them:
/// they are called by name in whatever language.
[[nodiscard]] ServiceMethods service_methods(const Catalogue& catalogue,
                                             const descriptor::SubsystemDescriptor& subsystem, PythonNames& names);

/// A method of a class: its first line, its description and what it returns.
[[nodiscard]] std::string method(const std::string& signature, const std::vector<std::string>& says,
                                 const std::string& body);

}  // namespace hirosco::ground
