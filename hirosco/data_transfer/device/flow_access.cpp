// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/flow_access.hpp"

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <utility>

#include "hirosco/data_transfer/device/flow_means.hpp"

namespace hirosco {
namespace {

/// What the row of its means says for a subsystem that is a user of its own; null: nothing.
[[nodiscard]] const OwnFlowAccess* own_access(const FlowMeans* means) noexcept {
  return means != nullptr ? means->access.own : nullptr;
}

}  // namespace

void let_in(const FlowAddress& flow, const std::string& instance, Sandbox& sandbox, ProcessUser user) {
  const FlowMeans* means = find_flow_means(flow.transfer);
  const OwnFlowAccess* own = own_access(means);
  if (means == nullptr || (user == ProcessUser::ItsOwn && own == nullptr)) return;
  const std::string address = address_in_flight(means->form, flow.address, instance);
  if (user == ProcessUser::ItsOwn && own->let_in != nullptr) own->let_in(address, sandbox);
  else means->access.let_in(address, sandbox);
}

bool is_reached(const FlowAddress& held, const Sandbox& sandbox) {
  const FlowMeans* means = find_flow_means(held.transfer);
  return means == nullptr || means->access.is_reached(held.address, sandbox);
}

Result<> make_place(const FlowAddress& flow, const std::string& instance) {
  const FlowMeans* means = find_flow_means(flow.transfer);
  if (means == nullptr || means->access.make_place == nullptr) return ok();
  return means->access.make_place(address_in_flight(means->form, flow.address, instance));
}

void remove_place(const FlowAddress& flow, const std::string& instance, ProcessUser user) {
  const FlowMeans* means = find_flow_means(flow.transfer);
  if (const OwnFlowAccess* own = own_access(means);
      user == ProcessUser::ItsOwn && own != nullptr && own->folder != nullptr) {
    namespace fs = std::filesystem;
    std::error_code failed;
    const std::string folder = own_folder(flow, instance);
    if (!fs::is_directory(fs::symlink_status(folder, failed))) return;
    if (own->forget != nullptr) own->forget(folder);
    // One with something else in it stays.
    fs::remove(folder, failed);
    return;
  }
  if (means != nullptr && means->access.remove_place != nullptr)
    means->access.remove_place(address_in_flight(means->form, flow.address, instance));
}

std::string memory_folder_of(const FlowAddress& flow, const std::string& instance) {
  const FlowMeans* means = find_flow_means(flow.transfer);
  if (means == nullptr || means->access.memory_folder == nullptr) return {};
  return means->access.memory_folder(address_in_flight(means->form, flow.address, instance));
}

std::string why_not_own(const FlowAddress& flow) {
  const OwnFlowAccess* own = own_access(find_flow_means(flow.transfer));
  if (own == nullptr) return "by " + std::string{to_text(flow.transfer)} + " nothing is known of whose it is";
  return own->why_not != nullptr ? std::string{own->why_not(flow.address)} : std::string{};
}

std::string own_folder(const FlowAddress& flow, const std::string& instance) {
  const FlowMeans* means = find_flow_means(flow.transfer);
  const OwnFlowAccess* own = own_access(means);
  if (own == nullptr || own->folder == nullptr) return {};
  return own->folder(address_in_flight(means->form, flow.address, instance));
}

Result<> make_own_place(const FlowAddress& flow, const std::string& instance, const OwnGroup& own, PlaceTime time) {
  const FlowMeans* means = find_flow_means(flow.transfer);
  const OwnFlowAccess* access = own_access(means);
  if (access == nullptr) return fail(ErrorCode::NotPermitted, "nothing is known of whose it is");
  if (access->make_folder == nullptr) return make_place(flow, instance);
  if (access->on_disk && time == PlaceTime::AtStart) return ok();
  return access->make_folder(address_in_flight(means->form, flow.address, instance), own);
}

void let_write(std::string place, Sandbox& sandbox) {
  if (std::ranges::find(sandbox.writable, place) == sandbox.writable.end())
    sandbox.writable.push_back(std::move(place));
}

bool may_write(const std::string& file, const Sandbox& sandbox) {
  return std::ranges::any_of(sandbox.writable, [&](const std::string& place) {
    return file.starts_with(place) &&
           (file.size() == place.size() || place.ends_with('/') || file[place.size()] == '/');
  });
}

}  // namespace hirosco
