// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// A made-up flight for the development server and for tests of the page alone: two coupled machines that swing, one of them
// failing at the end. With `hostile`, names, texts and values are such as nobody sends who means well.
const states = ['Offline', 'SoftwareInit', 'HardwareInit', 'PreOperational', 'SafeOperational', 'Operational', 'ErrorOperational', 'PostOperational',
  'HardwareDeinit', 'SoftwareDeinit'];
const edges = [[0, 1], [1, 2], [1, 9, 'failure'], [2, 3], [2, 8, 'failure'], [3, 4], [3, 7], [3, 6], [4, 5], [4, 7], [4, 6], [5, 4], [5, 6], [6, 7], [7, 3], [7, 8],
  [8, 9], [9, 0]];
export const markup = '<img src=x onerror="window.hurt=1"><script>window.hurt=1</script>';
const seconds = 60, rate_hz = 20, begin_t = 2145916838;

const column = (name, type, unit = '', rest = {}) => ({name, type, unit, ...rest});
const argument = (name, type, rest = {}) => ({name, type, unit: '', ...rest});

function subsystem(id, name, configurations, functions, columns, description = '') {
  return {id, name, description, states,
    configurations: configurations.map((one, i) => ({id: i + 1, name: one, sampling_hz: id < 10 ? 100 : 2000})),
    functions: [
      {name: 'SET_STATE', description: 'Brings the subsystem into a state', service: 8, subtype: 1, essential: false,
        arguments: [argument('STATE', 'UINT8', {enumeration: states.map((state, value) => ({value, name: state}))})]},
      {name: 'CONFIGURE', description: 'Takes a configuration', service: 8, subtype: 1, essential: false,
        arguments: [argument('CONFIGURATION', 'UINT8', {enumeration: configurations.map((one, i) => ({value: i + 1, name: one}))})]},
      ...functions.map((one) => ({description: '', service: 8, subtype: 1, essential: false, arguments: [], ...one}))],
    housekeeping: [{sid: 100 * id, period_s: 1 / rate_hz, configuration: 0, columns: columns.map((one) => ({...one, name: `${name}.${one.name}`}))}],
    events: [{id: 1, name: 'STATE_CHANGED', severity: 'info', arguments: [argument('STATE', 'UINT8')]}, {id: 2, name: 'LOST', severity: 'high', arguments: []}]};
}

function mission(hostile) {
  const both = (name, unit) => [0, 1].map((i) => column(`${name}[${i}]`, 'DOUBLE', unit));
  return {name: hostile ? markup : 'ROKVISS', id: 1, simulated: true, epoch_unix_s: 0, start_mode: 'telepresence',
    subsystems: [
      subsystem(1, 'SUPERVISOR', ['NOMINAL'], [{name: 'SET_MODE', arguments: [argument('MODE', 'UINT8')]}, {name: 'SAFE_ALL', essential: true}, {name: 'SHUTDOWN', essential: true, confirm: true},
        {name: 'LINK', arguments: [argument('LINK', 'UINT8', {min: 1})]}], [column('MODE', 'UINT8')]),
      subsystem(10, 'MANIPULATOR', ['STANDALONE', 'COUPLED'], [{name: 'MOVE_TO', description: hostile ? markup : 'Moves both joints', arguments: [
        argument('Q1', 'DOUBLE', {unit: 'rad', min: -2, max: 1}), argument('Q2', 'DOUBLE', {unit: 'rad', min: 0.2, max: 2.6}),
        argument('STEPS', 'UINT16')]}, {name: 'HOLD'}],
      [...both('CUR_VALUES.POSITION', 'rad'), ...both('CUR_VALUES.TORQUE', 'N m'), ...both('DES_POSITION', 'rad'), ...both('TIP_FORCE', 'N'),
        column('PHASE', 'UINT8', '', {enumeration: [{value: 0, name: hostile ? markup : 'REST'}, {value: 1, name: 'PUSH'}]}), column(hostile ? `${markup}` : 'TEMPERATURE', 'FLOAT', hostile ? markup : 'degC', {min: 0, max: 80})]),
      subsystem(11, 'JOYSTICK', ['STANDALONE', 'COUPLED'], [{name: 'PASSIVITY', arguments: [argument('ON', 'UINT8', {min: 0, max: 1})]}],
        [...both('CUR_VALUES.POSITION', 'rad'), ...both('CUR_VALUES.TORQUE', 'N m')], hostile ? 'x'.repeat(65536) : 'Joystick'),
    ],
    links: [{id: 1, from: 'MANIPULATOR', provides: hostile ? markup : 'ROBOT_STATE', to: 'JOYSTICK', requires: 'ROBOT_STATE', required: true, rate_hz: 2000, age_limit_cycles: 3},
      {id: 2, from: 'JOYSTICK', provides: 'JOYSTICK_STATE', to: 'MANIPULATOR', requires: 'JOYSTICK_STATE', required: true, rate_hz: 2000, age_limit_cycles: 3}],
    modes: [{id: 0, name: 'commissioning', permits: [{subsystem: '*', functions: ['SET_STATE', 'CONFIGURE', 'SET_MODE', 'LINK'], services: []}], commission: [], establish: []},
      {id: 1, name: 'telepresence', permits: [{subsystem: '*', functions: ['SET_STATE', 'SET_MODE', 'HOLD', 'PASSIVITY'], services: []}],
        commission: [{subsystem: 'MANIPULATOR', configuration: 'COUPLED', state: 'Operational'}, {subsystem: 'JOYSTICK', configuration: 'COUPLED', state: 'Operational'}],
        establish: [1, 2]}],
    devices: [{name: 'joystick', subsystem: 'JOYSTICK', device: 'JOYSTICK', faults: [{line: 'unplug', text: hostile ? markup : 'Unplugs it'}, {line: 'plug', text: 'Plugs it in'}]}],
    transitions: edges.map(([from, to, kind = 'commanded']) => ({from: states[from], to: states[to], kind}))};
}

function sample(t, hostile) {
  const a = 0.06 * Math.sin(0.7 * t), b = 0.08 * Math.sin(1.1 * t);
  const push = Math.max(0, Math.sin(0.3 * t) - 0.8) * 150;
  return {'SUPERVISOR.MODE': 1, 'MANIPULATOR.CUR_VALUES.POSITION[0]': -0.8 + a, 'MANIPULATOR.CUR_VALUES.POSITION[1]': 1.6 + b,
    'MANIPULATOR.DES_POSITION[0]': -0.8 + 1.04 * a, 'MANIPULATOR.DES_POSITION[1]': 1.6 + 1.04 * b, 'MANIPULATOR.CUR_VALUES.TORQUE[0]': push * 0.05,
    'MANIPULATOR.CUR_VALUES.TORQUE[1]': hostile ? 'NaN' : -push * 0.08, 'MANIPULATOR.TIP_FORCE[0]': -push, 'MANIPULATOR.TIP_FORCE[1]': hostile ? 'Infinity' : 0,
    'JOYSTICK.CUR_VALUES.POSITION[0]': a, 'JOYSTICK.CUR_VALUES.POSITION[1]': b, 'JOYSTICK.CUR_VALUES.TORQUE[0]': push * 0.001, 'JOYSTICK.CUR_VALUES.TORQUE[1]': 0,
    'MANIPULATOR.PHASE': push > 0 ? 1 : 0, [hostile ? `MANIPULATOR.${markup}` : 'MANIPULATOR.TEMPERATURE']: hostile ? markup : 20 + 0.05 * t};
}

/// What the gateway would tell of a stop: the answer of /api/why but its times.
const stop = {title: 'JOYSTICK lost its device. MANIPULATOR and JOYSTICK were stopped.', plan: 'network-down', mode: 'telepresence', mode_up: 'telepresence', severity: 'high',
  detail: 'MANIPULATOR and JOYSTICK went Offline within 2.5 ms, by plan network-down. SUPERVISOR goes on.', stopped: ['MANIPULATOR', 'JOYSTICK'],
  advice: 'Plug the joystick in, then bring telepresence up.', causes: [[0, 'high', 'JOYSTICK reports that its device is lost'],
    [0.1, 'medium', 'MANIPULATOR misses the samples of link 2'], [1.2, 'info', 'both in Error-Operational'], [2.5, 'info', 'both Offline']]
      .map(([after_ms, severity, text]) => ({after_ms, severity, text}))};

export function synthetic_flight({hostile = false} = {}) {
  const messages = [];
  const event = (t, id, name, number, severity, text) => messages.push({type: 'event', t: begin_t + t, apid: id, subsystem: name, id: number,
    name: number === 1 ? 'STATE_CHANGED' : hostile ? markup : 'LOST', severity, text, values: {}});
  for (const [id, name] of [[1, 'SUPERVISOR'], [10, 'MANIPULATOR'], [11, 'JOYSTICK']]) {
    states.slice(1, 6).forEach((state, i) => event(0.1 * i, id, name, 1, 'info', `STATE=${state}`));
  }
  for (let i = 10; i < seconds * rate_hz; ++i) {
    const t = i / rate_hz;
    const set = Object.fromEntries(Object.entries(sample(t, hostile)).map(([name, value]) => [name, [value, begin_t + t]]));
    messages.push({type: 'values', t: begin_t + t, set});
  }
  event(seconds - 4, 11, 'JOYSTICK', 2, 'high', hostile ? markup : '');
  if (hostile) event(seconds - 3, 10, 'MANIPULATOR', 2, 'low', `${'y'.repeat(65536)} ${markup}`);
  messages.sort((one, other) => one.t - other.t);
  return {mission: mission(hostile), messages, stop};
}
