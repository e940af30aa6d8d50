// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "supervisor/supervision/realtime_links/link_releases.hpp"

#include <array>
#include <iterator>
#include <string>
#include <utility>

#include "hirosco/pus/st128_realtime_link/link_handshake.hpp"

namespace hirosco::supervisor {

void LinkReleases::begin(std::uint8_t link, Done done) {
  const auto* described = mission_.find_link(link);
  releases_[link].done = std::move(done);
  const std::array data{std::byte{link}};
  // The consumer first, so that it never sees a producer that left.
  for (const std::string& name : {described->to, described->from})
    if (const std::uint16_t end = mission_.find_subsystem(name)->subsystem.id; graph_.holds(link, end))
      operator_.send_link_command(end, pus::st128::detach, data, {});
}

std::vector<std::uint8_t> LinkReleases::links() const {
  std::vector<std::uint8_t> all;
  for (const auto& [link, release] : releases_) all.push_back(link);
  return all;
}

void LinkReleases::refused(std::uint8_t link, std::uint16_t apid) {
  // Who has let go since refuses nothing: it has nothing left to let go of.
  if (const auto release = releases_.find(link); release != releases_.end())
    release->second.refused |= graph_.holds(link, apid);
}

void LinkReleases::end_those_let_go() {
  std::vector<Done> ended;
  for (auto entry = releases_.begin(); entry != releases_.end();) {
    const bool over = !graph_.is_held(entry->first);
    if (over) ended.push_back(std::move(entry->second.done));
    entry = over ? releases_.erase(entry) : std::next(entry);
  }
  for (const Done& done : ended)
    if (done) done(Released::ByBoth);
}

void LinkReleases::step(TimePoint now) {
  end_those_let_go();
  std::vector<Release> failed;
  for (auto entry = releases_.begin(); entry != releases_.end();) {
    Release& release = entry->second;
    if (release.deadline == TimePoint{}) release.deadline = now + LinkOperator::answer_limit;
    const bool ends = release.refused || now > release.deadline;
    if (ends) failed.push_back(std::move(release));
    entry = ends ? releases_.erase(entry) : std::next(entry);
  }
  for (const Release& each : failed)
    if (each.done) each.done(each.refused ? Released::Refused : Released::Unanswered);
}

}  // namespace hirosco::supervisor
