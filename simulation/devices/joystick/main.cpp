// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
#include "simulation/devices/device_shell.hpp"
#include "simulation/devices/joystick/evdev_stick.hpp"
#include "simulation/devices/joystick/joystick_device.hpp"

int main(int argc, char** argv) {
  using namespace hirosco;
  using namespace hirosco::simulation;
  return run_device(argc, argv, "hirosco-sim-joystick",
                    [](FlowFactory& flows, const FlowAddress& address, const SimulatedDevice::Settings& settings) {
                      return std::make_unique<JoystickDevice>(flows, address, settings, HandleParameters{},
                                                              EvdevStick::open);
                    });
}
