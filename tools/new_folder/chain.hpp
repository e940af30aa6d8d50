// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// `hirosco new robot --chain`: one arm of a robot that has more joints than an arm may have (docs/adr/0131).
namespace hirosco::tools {

/// A link, and how many joints move it by themselves.
struct ChainEnd {
  std::string link;
  std::size_t joints{0};
};
/// Those that carry nothing and that joints move, by most of them first. `text`: of a URDF file; none where it is no XML.
[[nodiscard]] std::vector<ChainEnd> chain_ends(std::string_view text);

/// How many joints move by themselves in the arm of this URDF file with this tool; 0: it cannot be flown.
using JointsThatFly = std::function<std::size_t(const std::string& urdf, const std::string& tip)>;
/// What can be flown of a robot that is no arm as a whole: chains to its ends, or as far towards one as all is well and more than half of its
/// joints are on the way. Those with most joints first; of those that move the same joints one, and `most` in all.
[[nodiscard]] std::vector<ChainEnd> chains_that_fly(std::string_view text, std::size_t most,
                                                    const JointsThatFly& joints_that_fly);

struct Chain {
  std::string urdf;  ///< the file; only the types of `standing` are others: fixed
  std::vector<std::string> standing;  ///< joints, in the order of the file
};
/// Only joints on the way from the root to `tip` or to one of `joints`, these, and who is mimicked by or mimics them, still move; the others stand
/// at 0.
[[nodiscard]] Chain keep_chain(std::string_view text, const std::string& tip, std::span<const std::string> joints);
[[nodiscard]] bool has_link(std::string_view text, const std::string& link);

}  // namespace hirosco::tools
