// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "hirosco/descriptor/model/setting_files.hpp"

#include <gtest/gtest.h>

namespace hirosco::descriptor {
namespace {

/// ARM in two configurations, and LAMP, which says the same word of itself.
[[nodiscard]] SubsystemDescriptor with_models(const char* one, const char* other) {
  SubsystemDescriptor subsystem;
  subsystem.devices.resize(2);
  subsystem.devices[0].name = "LAMP";
  subsystem.devices[1].name = "ARM";
  for (const char* value : {one, other}) {
    Configuration configuration;
    configuration.devices.resize(2);
    configuration.devices[0].device = 0;
    configuration.devices[0].settings.push_back({.name = "MODEL_FILE", .value = "lamp.urdf", .at = {}});
    configuration.devices[1].device = 1;
    if (value != nullptr) configuration.devices[1].settings.push_back({.name = "MODEL_FILE", .value = value, .at = {}});
    subsystem.configurations.push_back(std::move(configuration));
  }
  return subsystem;
}

TEST(SettingOfAll, IsWhatEveryConfigurationSaysThatSaysIt) {
  EXPECT_EQ(setting_of_all(with_models("arm.urdf", "arm.urdf"), "ARM", "MODEL_FILE").value(), "arm.urdf");
  EXPECT_EQ(setting_of_all(with_models(nullptr, "arm.urdf"), "ARM", "MODEL_FILE").value(), "arm.urdf");
  EXPECT_EQ(setting_of_all(with_models("arm.urdf", "arm.urdf"), "ARM", "TIP").value(), "");
}

TEST(SettingOfAll, IsRefusedWhereConfigurationsSayDifferentThings) {
  const auto two = setting_of_all(with_models("arm.urdf", "other.urdf"), "ARM", "MODEL_FILE");
  ASSERT_FALSE(two);
  EXPECT_EQ(two.error().code, ErrorCode::Mismatch);
}

}  // namespace
}  // namespace hirosco::descriptor
