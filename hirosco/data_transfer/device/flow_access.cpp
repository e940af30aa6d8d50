// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/data_transfer/device/flow_access.hpp"

#include <algorithm>
#include <utility>

#include "hirosco/data_transfer/device/flow_means.hpp"

namespace hirosco {

void let_in(const FlowAddress& flow, const std::string& instance, Sandbox& sandbox) {
  if (const FlowMeans* means = find_flow_means(flow.transfer); means != nullptr)
    means->access.let_in(address_in_flight(means->form, flow.address, instance), sandbox);
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

void remove_place(const FlowAddress& flow, const std::string& instance) {
  const FlowMeans* means = find_flow_means(flow.transfer);
  if (means != nullptr && means->access.remove_place != nullptr)
    means->access.remove_place(address_in_flight(means->form, flow.address, instance));
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
