// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/spacecraft/catalogue.hpp"

#include "simulation/devices/joystick_device.hpp"
#include "simulation/devices/robot_device.hpp"
#include "subsystems/hello/hello.hpp"
#include "subsystems/joystick/joystick.hpp"
#include "subsystems/manipulator/manipulator.hpp"

namespace hirosco::simulation {

const SubsystemCatalogue& known_subsystems() {
  static const SubsystemCatalogue catalogue{
      {"hirosco-hello", make_hello}, {"hirosco-manipulator", make_manipulator}, {"hirosco-joystick", make_joystick}};
  return catalogue;
}

const DeviceCatalogue& known_devices() {
  static const DeviceCatalogue catalogue{
      {"hirosco-sim-robot",
       [](FlowFactory& flows, const FlowAddress& address, const SimulatedDevice::Settings& settings) {
         return std::make_unique<RobotDevice>(flows, address, settings);
       }},
      {"hirosco-sim-joystick",
       [](FlowFactory& flows, const FlowAddress& address, const SimulatedDevice::Settings& settings) {
         return std::make_unique<JoystickDevice>(flows, address, settings);
       }}};
  return catalogue;
}

}  // namespace hirosco::simulation
