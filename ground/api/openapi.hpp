// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>

namespace hirosco::ground {

/// The API in OpenAPI's words, made of routes() and schemas(). Everything but the WebSocket, which OpenAPI has no words for.
[[nodiscard]] nlohmann::json openapi_document();

/// What bodies and answers look like, by name. A field that may be absent is not among the `required`.
[[nodiscard]] nlohmann::json schemas();

}  // namespace hirosco::ground
