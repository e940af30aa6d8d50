// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "hirosco/descriptor/read/read.hpp"
#include "robotics/shapes/enclosing.hpp"

namespace hirosco::robotics {

/// What encloses a link, or a part of it, in its frame.
struct LinkHull {
  std::string link;
  RoundedHull hull;
  std::optional<RoundedHull>
      standing{};  ///< of a link that somebody else moves (swept.hpp), whose hull is all along its way: it as it stands
};

/// What the file has as <collision> of its links.
struct CollisionShapes {
  std::vector<LinkHull> hulls;
  std::vector<std::string> unseen;  ///< links with a shape that nothing encloses, each once; why is told by a warning
};

/// Balls, boxes and cylinders enclosed exactly but for what makes a cylinder round, meshes beside the file by pieces (enclosing()). `text` is of a
/// robot that urdf::read() takes. A mesh that is not there costs its link (warnings), one that is wrong the whole: with its own file, line and column
/// (docs/urdf-errors.md, U0701 on).  Realtime: allocates.
[[nodiscard]] descriptor::Reading<CollisionShapes> read_collision_shapes(const std::filesystem::path& file,
                                                                         std::string_view text,
                                                                         const descriptor::FileSource& source,
                                                                         const Fineness& fineness = {});

}  // namespace hirosco::robotics
