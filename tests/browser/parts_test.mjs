// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
//
// What the page reckons without a browser: goals that are dragged, small steps of a tool, numbers in the words of forms and axes, expressions
// of parameters, plots of a part, borders between panels, latencies of links, samples of a long time, lines of a log, stacks of telecommands as text, triangles, when the next picture is drawn; how large it is.
import assert from 'node:assert/strict';
import {readFileSync, readdirSync} from 'node:fs';
import {join} from 'node:path';
import {before, describe, it} from 'node:test';
import {pathToFileURL} from 'node:url';
import {gzipSync} from 'node:zlib';

const page_folder = process.env.HIROSCO_PAGE;

const of_page = (file) => import(pathToFileURL(join(process.env.HIROSCO_SOURCES, 'ground/web/page', file)));
const {beyond_rad, reach} = await of_page('scene/reach.js');
const {goal_texts, led_value, number_in, numbers_in} = await of_page('parts/numbers.js');
const {jog_of, paces, push_of, renewed_after_ms} = await of_page('parts/jog_steps.js');
const {in_words, ticks_text} = await of_page('format.js');
const {borne_by, missed_words, MissedLately, rate_of, share_text} = await of_page('parts/missed.js');
const {cube_as_seen, cube_px, direction_of, turned_by, words_of: seen_from} = await of_page('scene/view_cube.js');
const {risings} = await of_page('parts/risings.js');
const {joint_above, plots_of_angle, plots_of_link} = await of_page('parts/joint_plots.js');
const {extent_of, moved, remembered, template_of} = await of_page('parts/splits_reckoned.js');
const {height_of, is_kept, late_count, place_of, quantile_ns} = await of_page('parts/latency.js');
const {parse, reckon} = await of_page('parts/expression.js');
const {most_lines, with_newest} = await of_page('parts/log_lines.js');
const {thinned} = await of_page('parts/thinned.js');
const {most_rows, read_stack, stack_text, words_of} = await of_page('parts/stack_text.js');

const near = (one, other, what = '') => assert.ok(Math.hypot(...one.map((value, i) => value - other[i])) < 1e-4, `${what} ${one} instead of ${other}`);

describe('a part of the robot that is clicked', () => {
  const columns = new Map([['ARM.CUR.POSITION', 'rad', 2], ['ARM.CUR.VELOCITY', 'rad/s', 2], ['ARM.CUR.TORQUE', 'N m', 2], ['ARM.DES_POSITION', 'rad', 2], ['ARM.KEPT_OUT', 'rad', 3], ['ARM.TIP_FORCE', 'N', 2],
    ['OTHER.POSITION', 'rad', 2], ['OTHER.TORQUE', 'N m', 2]].flatMap(([base, unit, count]) => Array.from({length: count}, (_, i) => ({name: `${base}[${i}]`, unit, subsystem: base.split('.')[0]}))).map((one) => [one.name, one]));
  const about = {joints: {shoulder: 'ARM.CUR.POSITION[0]', elbow: 'ARM.CUR.POSITION[1]'}, tip: 'finger', force: ['ARM.TIP_FORCE[0]', 'ARM.TIP_FORCE[1]', 'ARM.UNKNOWN']};
  const link = (name, parent) => ({isURDFLink: true, name, parent}), joint = (name, parent) => ({isURDFJoint: true, name, parent});
  const base = link('base', null), upper = link('upper', joint('shoulder', base)), lower = link('lower', joint('elbow', upper)), hand = link('hand', joint('screwed on', lower)), finger = link('finger', joint('screwed on, too', hand));
  const links = {base, upper, lower, hand, finger};

  it('shows the angle of the joint that moves it with its set point, and the torque', () => {
    assert.deepEqual(plots_of_link(upper, {about, links}, columns), [['ARM.CUR.POSITION[0]', 'ARM.DES_POSITION[0]'], ['ARM.CUR.TORQUE[0]']]);
    assert.deepEqual(plots_of_link(hand, {about, links}, columns), [['ARM.CUR.POSITION[1]', 'ARM.DES_POSITION[1]'], ['ARM.CUR.TORQUE[1]']], 'what is fixed to a link goes with it');
    assert.equal(joint_above(hand, Object.keys(about.joints)), 'elbow');
  });

  it('shows the forces of a tip, all joints of a handle, and nothing of what stands still', () => {
    assert.deepEqual(plots_of_link(finger, {about, links}, columns), [['ARM.TIP_FORCE[0]', 'ARM.TIP_FORCE[1]']]);
    assert.deepEqual(plots_of_link(finger, {about: {...about, force: about.force.slice(0, 2)}, links}, columns), [['=hypot(ARM.TIP_FORCE[0], ARM.TIP_FORCE[1])', 'ARM.TIP_FORCE[0]', 'ARM.TIP_FORCE[1]']],
      'first the one number that stands at the arrow');
    assert.deepEqual(plots_of_link(lower, {about: {joints: about.joints, handle: 'lower'}, links}, columns), [['ARM.CUR.POSITION[0]', 'ARM.CUR.POSITION[1]'], ['ARM.CUR.TORQUE[0]', 'ARM.CUR.TORQUE[1]']]);
    assert.deepEqual(plots_of_link(base, {about, links}, columns), []);
    assert.deepEqual(plots_of_angle('ARM.NOTHING[0]', columns), []);
  });
});

describe('cycles that were missed', () => {
  it('are told as a rate of the last minute, and begin anew with a smaller count or an earlier time', () => {
    const lately = new MissedLately();
    for (let t = 0; t <= 300; t += 0.2) lately.take(t, [{name: 'ARM', cycles: 2000 * t, missed: t < 200 ? 40 : 40 + Math.floor((t - 200) / 10)}]);
    const told = lately.of('ARM', 50);
    assert.equal(told.seconds, 60);
    assert.ok(Math.abs(told.count - 6) <= 1, `${told.count} of one each 10 s`);
    assert.equal(rate_of({count: 1, seconds: 30}), 2);
    assert.deepEqual([told, {count: told.cycles / 250, cycles: told.cycles}, {count: 3, cycles: 100}, {count: 5, cycles: NaN}].map(share_text), ['less than 0.01 %', '0.40 %', '3.0 %', '5'], 'of those that were due');
    lately.take(301, [{name: 'ARM', missed: 0}]);
    assert.equal(lately.of('ARM', 0), null, 'started again');
    lately.take(303, [{name: 'ARM', missed: 0}]);
    lately.take(100, [{name: 'ARM', missed: 3}]);
    assert.equal(lately.of('ARM', 3), null, 'another flight');
    assert.equal(lately.of('HAND', 3), null);
  });

  it('stand beside what is too many: of the links that need their samples the one that bears least', () => {
    const links = [{from: 'ARM', to: 'HAND', required: true, age_limit_cycles: 5}, {from: 'ARM', to: 'LOG', required: true, age_limit_cycles: 3}, {from: 'ARM', to: 'EYE', required: false, age_limit_cycles: 1},
      {from: 'HAND', to: 'ARM', required: true, age_limit_cycles: null}];
    assert.deepEqual(borne_by('ARM', links), {cycles: 3, who: 'LOG'});
    assert.equal(borne_by('HAND', links), null);
    assert.equal(missed_words({missed: 12, cycles: 120000, lately: {count: 3, seconds: 60}, borne: borne_by('ARM', links)}),
      '12 of 120,012 cycles missed since the start, 3 in the last 60 s. LOG is stopped when it lacks samples for 3 cycles in a row.');
  });
});

describe('the cube that says from where the scene is seen', () => {
  /// [right, up, towards the eye] of an eye that looks from there with z up.
  const axes_of = (eye) => {
    const [x, y, z] = eye, flat = Math.hypot(x, y), right = flat ? [-y / flat, x / flat, 0] : [1, 0, 0];
    return [right, [-z * right[1], z * right[0], x * right[1] - y * right[0]], eye];
  };
  const unit = (x, y, z) => [x, y, z].map((value) => value / Math.hypot(x, y, z));
  const shown = (eye) => cube_as_seen(axes_of(eye));
  const names = (list) => list.map((one) => one.name).sort();

  it('shows the faces that are towards the eye, and the edges of those', () => {
    assert.deepEqual(names(shown(unit(0, -1, 0.02)).faces), ['front']);
    assert.deepEqual(names(shown(unit(0.4, -1, 0.6)).faces), ['front', 'right', 'top']);
    assert.deepEqual(names(shown([0, 0, 1]).faces), ['top']);
    assert.deepEqual(names(shown([0, 0, 1]).edges), ['top back', 'top front', 'top left', 'top right']);
    assert.deepEqual(names(shown(unit(0, -1, 0.02)).edges), ['front right', 'left front', 'top front']);
  });

  it('stands upright in its own picture: what is right in the scene is right here, and the top above', () => {
    const {faces} = shown(unit(0.2, -1, 0.5)), middle = (name) => faces.find((one) => one.name === name).matrix.slice(4);
    assert.ok(middle('right')[0] > middle('front')[0] && middle('top')[1] < middle('front')[1]);
    for (const {corners} of faces) for (const [x, y] of corners) assert.ok(x > 0 && y > 0 && x < cube_px && y < cube_px, `${x}, ${y}`);
    const front = faces.find((one) => one.name === 'front');
    assert.ok(front.matrix[0] > 0.9 && front.matrix[3] > 0.7, 'its word is read from left to right');
  });

  it('looks from where a face or an edge points', () => {
    assert.deepEqual(direction_of('right'), [1, 0, 0]);
    assert.deepEqual(direction_of('top front'), unit(0, -1, 1));
    assert.deepEqual(direction_of('front right'), unit(1, -1, 0));
  });

  it('is turned by keys to the next eighth, not below the horizon nor over the top', () => {
    near(turned_by(unit(0.1, -1, 0.5), [1, 0]), [Math.SQRT1_2, -Math.SQRT1_2, 0].map((value) => value * Math.cos(Math.asin(unit(0.1, -1, 0.5)[2]))).with(2, unit(0.1, -1, 0.5)[2]));
    near(turned_by([0, -1, 0], [0, 1]), unit(0, -1, 1));
    near(turned_by(unit(0, -1, 1), [0, 1]), [0, 0, 1]);
    assert.ok(turned_by(unit(0, -1, 0.1), [0, -1])[2] > 0);
    assert.deepEqual([seen_from([0, 0, 1]), seen_from([1, 0, 0]), seen_from(unit(0.2, -1, 0.8))], ['from above', 'from the right', 'from the front, above']);
  });
});

describe('what came up', () => {
  const modes = [{id: 0, name: 'commissioning', commission: []}, {id: 1, name: 'pair', commission: [{subsystem: 'ARM', state: 'Operational'}, {subsystem: 'HAND', state: 'Operational'}]}];
  const state = (t, subsystem, name) => ({t, subsystem, state: name}), mode = (t, id) => ({t, mode: id});

  it('is told when the last member and the mode are there, each time, and not of what was up before anybody looked', () => {
    const changes = [mode(1, 0), state(1, 'ARM', 'Offline'), state(1, 'HAND', 'Offline'), state(2, 'ARM', 'Operational'), state(3, 'HAND', 'Operational'), mode(4, 1), state(9, 'HAND', 'Offline'), state(12, 'HAND', 'Operational')];
    assert.deepEqual(risings(changes, modes), [{t: 4, name: 'pair'}, {t: 12, name: 'pair'}]);
    assert.deepEqual(risings([mode(1, 1), state(1, 'ARM', 'Operational'), state(1, 'HAND', 'Operational'), state(5, 'ARM', 'Operational')], modes), []);
  });
});

describe('an event in words', () => {
  it('has names for numbers of subsystems and none of the words of programmers', () => {
    const name_of = (apid) => ({10: 'ARM'})[apid];
    assert.equal(in_words('APID=10 BUDGET=70 W RESERVED=20 W', name_of), 'ARM budget 70 W reserved 20 W');
    assert.equal(in_words('REASON=hung up SILENT_CYCLES=0', name_of), 'connection closed silent cycles 0');
    assert.equal(in_words('APID=77', name_of), 'apid 77');
    assert.equal(in_words('three words of text', name_of), 'three words of text');
  });
});

describe('a border between panels', () => {
  it('gives one what it takes from the next, and leaves the others alone', () => {
    assert.deepEqual(moved([300, 500, 280], 0, 60, 200), [360, 440, 280]);
    assert.deepEqual(moved([300, 500, 280], 1, -60, 200), [300, 440, 340]);
  });

  it('makes none smaller than it may be, nor grows one that is smaller', () => {
    assert.deepEqual(moved([300, 500, 280], 0, 900, 200), [600, 200, 280]);
    assert.deepEqual(moved([300, 500, 280], 0, -900, 200), [200, 600, 280]);
    assert.deepEqual(moved([150, 500], 0, -10, 200), [150, 500]);
    assert.deepEqual(moved([150, 500], 0, 10, 200), [160, 490]);
  });

  it('is remembered for as many panels as there are, and nothing else is', () => {
    assert.deepEqual(remembered('[300,500]', 2), [300, 500]);
    for (const text of ['[300,500]', null, 'nonsense', '[300,"x",5]', '[300,0,5]', '{}']) assert.equal(remembered(text, 3), null, text);
    assert.equal(template_of([300, 120], 200), 'minmax(min(200px, 300px), 300.0fr) minmax(min(200px, 120px), 120.0fr)');
  });

  it('is where panels end at it, and not across one that spans it', () => {
    const boxes = [{end: 200, from: 8, to: 300}, {end: 202, from: 308, to: 400}, {end: 900, from: 408, to: 700}];
    assert.deepEqual(extent_of(boxes, 201, 4), [8, 400]);
    assert.equal(extent_of(boxes, 500, 4), null);
  });
});

describe('latencies of a link, counted in nine bins', () => {
  const period_ns = 500000, of = (...counts) => ({counts, period_ns});

  it('say within what a part of the samples came, by the bound of a bin, and never more than the longest', () => {
    const told = of(0, 0, 0, 0, 10, 80, 9, 1, 0);
    assert.equal(quantile_ns(told, 0.5), 250000);
    assert.equal(quantile_ns(told, 0.99), 500000);
    assert.equal(quantile_ns(told, 0.991), 1000000);
    assert.equal(quantile_ns(told, 0.991, 620000), 620000);
    assert.equal(quantile_ns(told, 0.5, 240000), 240000);
    assert.equal(quantile_ns(of(0, 0, 0, 0, 0, 0, 0, 0, 5), 0.5, 7000000), 7000000, 'nothing but the longest bounds the last bin');
    assert.ok(Number.isNaN(quantile_ns(of(0, 0, 0, 0, 0, 0, 0, 0, 0), 0.5)), 'no sample has no median');
  });

  it('are late from the bin on that begins with the budget', () => {
    const told = of(1, 1, 1, 1, 1, 1, 10, 100, 1000);
    assert.equal(late_count(told, period_ns), 1100);
    assert.equal(late_count(told, 2 * period_ns), 1000);
    assert.deepEqual([[3, 4, 2], [4, 4, 2], [3, NaN, 2], [1.5, 1.8, 2], [NaN, 4, 2]].map((one) => is_kept(...one)), [true, false, false, false, false]);
    assert.equal(late_count(told, 1.5 * period_ns), 1000, 'what the budget cuts is not called late');
    assert.equal(late_count(told, 4 * period_ns), 0);
  });

  it('stand where their bin does', () => {
    assert.equal(place_of(period_ns, period_ns), 7);
    assert.equal(place_of(period_ns / 64, period_ns), 1);
    assert.equal(place_of(1, period_ns), 0);
    assert.equal(place_of(1e12, period_ns), 9);
  });

  it('show one of a million, and none as none', () => {
    assert.equal(height_of(0, 1e6), 0);
    assert.ok(height_of(1, 1e6) > 0.1);
    assert.ok(Math.abs(height_of(1e6, 1e6) - 1) < 1e-9);
  });
});

describe('a goal that is dragged', () => {
  /// Two links in a plane, as rokviss has them.
  const tip = ([a, b]) => [0.19 * Math.cos(a) + 0.2 * Math.cos(a + b), 0.19 * Math.sin(a) + 0.2 * Math.sin(a + b), 0.075];
  const joints = [{lower: -2, upper: 1, free: true}, {lower: 0.2, upper: 2.6, free: true}];
  const size_m = 0.5;

  it('brings the tip to where the mouse is, wherever that can be reached', () => {
    let angles = [-0.8, 1.6];
    for (const wanted of [[-0.5, 1.2], [-1.4, 2.3], [0.4, 0.7], [-1.9, 2.5]]) {
      angles = reach(tip, joints, angles, tip(wanted), size_m);
      near(tip(angles), tip(wanted), `to ${wanted}`);
    }
  });

  it('stays near when the mouse goes where no arm reaches, and comes back', () => {
    const far = reach(tip, joints, [-0.8, 1.6], [3, 0, 0.075], size_m);
    assert.ok(far.every(Number.isFinite));
    near(tip(reach(tip, joints, far, tip([-0.5, 1.2]), size_m)), tip([-0.5, 1.2]));
  });

  it('shows a joint beyond its range a little, so that it is seen that it cannot go there', () => {
    const [, elbow] = reach(tip, joints, [0, 0.3], tip([0, 0]), size_m);
    assert.ok(elbow >= joints[1].lower - beyond_rad - 1e-9 && elbow < joints[1].lower, `${elbow}`);
  });

  it('turns one joint alone when a link is led', () => {
    const found = reach(tip, [joints[0], {...joints[1], free: false}], [-0.8, 1.6], tip([-0.2, 1.6]), size_m);
    near(found, [-0.2, 1.6]);
  });

  it('takes an arm of six joints to a place in space', () => {
    const six = (q) => {
      let at = [0, 0, 0], frame = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
      q.forEach((angle, i) => {
        const [u, v] = [[0, 1], [0, 2], [0, 2], [1, 2], [0, 1], [1, 2]][i], c = Math.cos(angle), s = Math.sin(angle);
        frame = frame.map((row) => row.map((value, k) => k === u ? c * row[u] + s * row[v] : k === v ? c * row[v] - s * row[u] : value));
        at = at.map((value, k) => value + 0.2 * frame[k][2]);
      });
      return at;
    };
    const free = new Array(6).fill({lower: -3, upper: 3, free: true}), wanted = six([0.5, 0.2, 0.9, -0.3, 0.4, 0.1]);
    near(six(reach(six, free, [0.2, 0.5, 1.2, -0.6, 0.7, 0.1], wanted, 1.2)), wanted);
  });

  it('stands in the form as words: an argument for each joint, or all of an array', () => {
    assert.deepEqual(goal_texts({joints: {a: 'Q1', b: 'Q2'}}, {a: -1.38049, b: 2}), {Q1: '-1.38', Q2: '2'});
    assert.deepEqual(goal_texts({joints: {b: 'GOAL[1]', a: 'GOAL[0]'}}, {a: 0.1234, b: -0.5}), {GOAL: '0.123 -0.5'});
  });
});

describe('numbers in words', () => {
  it('are read with any keyboard’s minus and comma, and are none where anything else stands', () => {
    assert.deepEqual(['−1,5', '+2e-3', ' .5 '].map(number_in), [-1.5, 0.002, 0.5]);
    for (const word of ['', 'NaN', '0x1', '1 2', 'left', undefined]) assert.ok(Number.isNaN(number_in(word)), word);
    assert.deepEqual(numbers_in('1; 2,5  -3', 3), [1, 2.5, -3]);
    assert.equal(led_value({GOAL: [1, 2, 3]}, 'GOAL[2]'), 3);
  });

  it('have the digits of their step at an axis', () => {
    assert.deepEqual(ticks_text([-0.85, -0.8, -0.75]), ['−0.85', '−0.80', '−0.75']);
    assert.deepEqual(ticks_text([-0.825, -0.8, null]), ['−0.825', '−0.800', '']);
    assert.deepEqual(ticks_text([0, 5, 10]), ['0', '5', '10']);
  });
});

describe('the pushes of a tool', () => {
  const action = {arguments: [{name: 'LINEAR', count: 3, unit: 'm/s', min: -1, max: 0.03}, {name: 'ANGULAR', count: 3, unit: 'rad/s', min: -2, max: 2}, {name: 'SECONDS', unit: 's', min: 0.01, max: 1}]};

  it('are there for a telecommand of two velocities and a time, and for no other', () => {
    assert.equal(jog_of(action).linear.name, 'LINEAR');
    const joints = {arguments: [{name: 'VELOCITY', count: 6, unit: 'rad/s'}, {name: 'SECONDS', unit: 's'}]};
    for (const other of [{arguments: action.arguments.slice(0, 2)}, joints, {}]) assert.equal(jog_of(other), null);
  });

  it('go along one axis or about it, to one side, and no faster than the descriptor permits', () => {
    const jog = jog_of(action), [fine, , coarse] = paces;
    assert.deepEqual(push_of(jog, {turning: false, axis: 1, side: -1}, fine), {LINEAR: [0, -0.005, 0], ANGULAR: [0, 0, 0], SECONDS: 0.4});
    assert.deepEqual(push_of(jog, {turning: true, axis: 2, side: 1}, fine), {LINEAR: [0, 0, 0], ANGULAR: [0, 0, 0.05], SECONDS: 0.4});
    assert.deepEqual(push_of(jog, {turning: false, axis: 0, side: 1}, coarse).LINEAR, [0.03, 0, 0]);
    for (const pace of paces) assert.equal(renewed_after_ms(pace), 500 * push_of(jog, {turning: false, axis: 0, side: 1}, pace).SECONDS, 'renewed in its middle');
  });
});

describe('an expression of parameters', () => {
  const columns = {'ARM.FORCE[0]': {unit: 'N'}, 'ARM.FORCE[1]': {unit: 'N'}, 'ARM.Q': {unit: 'rad'}, 'ARM.MODE': {unit: '', words: true}};
  const read = (text) => parse(text, (name) => new Map(Object.entries(columns)).get(name.replace(/@\d+$/, '')), Object.keys(columns));
  const value = (text, ...values) => read(text).at(values);
  const problem = (text) => { try { read(text); } catch (error) { return error.message; } return 'none'; };

  it('reckons as it is written: powers before products before sums, from the left', () => {
    for (const [text, expected] of [['ARM.Q*0 + 2 + 3 * 4', 14], ['ARM.Q*0+2 - 3 - 4', -5], ['-2^2 + ARM.Q*0', -4], ['2^3^2+0*ARM.Q', 512], ['12/3/2 +0*ARM.Q', 2], ['(1 + 2) * 3+ARM.Q*0', 9],
      ['max(1, 3, 2) - hypot(3, 4) + 0 * ARM.Q', -2], ['1.5e2 + .5 + 0*ARM.Q', 150.5], ['atan2(1, 1) * 4 - pi + 0 * ARM.Q', 0], ['- -2 + ARM.Q*0', 2]]) assert.equal(value(text, 1), expected, text);
    assert.equal(value('ARM.FORCE[0] * 2 - abs(ARM.FORCE[1])', 3, -4), 2);
    assert.deepEqual(read('ARM.FORCE[0] - ARM.FORCE[0]@3').inputs, ['ARM.FORCE[0]', 'ARM.FORCE[0]@3']);
  });

  it('has the unit that follows from those of its parameters, and none where they do not agree', () => {
    for (const [text, unit] of [['ARM.FORCE[0] * 2 - 1', 'N'], ['hypot(ARM.FORCE[0], ARM.FORCE[1])', 'N'], ['ARM.FORCE[0] / ARM.FORCE[1]', ''], ['ARM.FORCE[0] + ARM.Q', ''], ['deg(ARM.Q)', 'deg'], ['sin(ARM.Q)', '']]) {
      assert.equal(read(text).unit, unit, text);
    }
  });

  it('says what is wrong, where, and what may have been meant', () => {
    for (const [text, words] of [['ARM.FORCE[0', /“\[” is neither/], ['ARM.FROCE[0] * 2', /no parameter “ARM.FROCE\[0\]”, did you mean ARM.FORCE\[0\]\?, at character 1/], ['2 * (ARM.Q', /“\)” is missing, at character 11/],
      ['ARM.Q +', /ends where a number/], ['ARM.Q ARM.Q', /“ARM.Q” follows/], ['abss(ARM.Q)', /no function “abss”, did you mean abs\?/], ['sqrt(ARM.Q, 2)', /sqrt is of 1 value, not of 2/], ['1 + 2', /no parameter is in it/],
      ['ARM.MODE * 2', /words for values/], ['', /nothing is written/], ['ARM.Q; alert(1)', /“;” is neither/], ['constructor(ARM.Q)', /no function/], ['__proto__', /no parameter/], ['* 2', /not “\*”/]]) assert.match(problem(text), words, text);
  });

  it('is bounded, whatever is sent as an address', () => {
    assert.match(problem(`${'('.repeat(100)}ARM.Q${')'.repeat(100)}`), /nested deeper/);
    assert.match(problem('-'.repeat(200) + 'ARM.Q'), /nested deeper/);
    assert.match(problem(Array(75).fill('1').join('+') + '+ARM.Q'), /more than 120/);
    assert.match(problem('1'.repeat(301)), /at most 300/);
  });

  it('has a value at each sample of any parameter, and none where one has been silent for too long', () => {
    const program = read('ARM.FORCE[0] / ARM.FORCE[1]');
    const {t, v} = reckon(program, [{t: [1, 2, 3, 9], v: [10, 20, null, 30]}, {t: [1.5, 2, 4, 8.5], v: [2, 4, 0, 5]}], [2, 2]);
    assert.deepEqual(t, [1, 1.5, 2, 3, 4, 8.5, 9]);
    assert.deepEqual(v, [null, 5, 5, null, null, null, 6]);
  });
});

describe('samples of a long time', () => {
  it('go back as far as before, coarser where they are old, with every least and most, and with their gaps', () => {
    const none = [null, null, null, null, null, null, null];
    const halves = (low, high) => (low + high) / 2;
    const once = thinned({t: [0, 1, 2, 3, 4, 5, 6], v: [1, 9, null, -5, 7, 3, 4], low: none, high: none}, 5, halves);
    assert.deepEqual(once, {t: [0, 2, 3, 5, 6], v: [5, null, 1, 3, 4], low: [1, null, -5, null, null], high: [9, null, 7, null, null]});
    const twice = thinned({t: [0, 1, 2], v: [5, 1, 3], low: [1, -5, null], high: [9, 7, null]}, 3, halves);
    assert.deepEqual(twice, {t: [0, 2], v: [2, 3], low: [-5, null], high: [9, null]});
  });
});

describe('the lines of a log that goes on', () => {
  const lines = (...numbers) => numbers.map((number) => ({number}));

  it('are those that are new before those that were there, each once', () => {
    assert.deepEqual(with_newest({packets: lines(7, 5, 2), before: null}, {packets: lines(9, 8, 7, 5), before: 5}), {packets: lines(9, 8, 7, 5, 2), before: null});
    const found = {packets: lines(7, 5), before: 5};
    assert.equal(with_newest(found, {packets: [], before: 3}), found, 'words that the newest packets do not have');
  });

  it('have no hole that nobody sees: so many new ones that they do not reach the old ones take their place', () => {
    const answer = {packets: lines(30, 29), before: 29};
    assert.equal(with_newest({packets: lines(7, 5), before: 5}, answer), answer);
  });

  it('go back with a replay', () => {
    const answer = {packets: lines(5, 2), before: null};
    assert.equal(with_newest({packets: lines(7, 5, 2), before: null}, answer), answer);
  });

  it('are bounded, and older ones are asked for from where they end', () => {
    const all = Array.from({length: most_lines}, (_, i) => ({number: most_lines - i}));
    const {packets, before} = with_newest({packets: all, before: null}, {packets: lines(most_lines + 2, most_lines + 1, most_lines), before: most_lines});
    assert.deepEqual([packets.length, packets[0].number, packets.at(-1).number, before], [most_lines, most_lines + 2, 3, 3]);
  });
});

describe('a stack of telecommands as text', () => {
  const action = {name: 'SET', arguments: [{name: 'MODE', type: 'UINT8'}, {name: 'GOAL', type: 'DOUBLE', count: 2}, {name: 'NOTE', type: 'TEXT'}]};
  const find = (subsystem, name) => subsystem.toLowerCase() !== 'arm' ? `there is no subsystem ${subsystem}` : name.toLowerCase() !== 'set' ? `no ${name}` :
    {subsystem: 'ARM', action, choices: ({name: of}) => of === 'MODE' ? [{name: 'Safe-Operational', value: 4}] : []};

  it('comes back as it was written, whatever its texts are', () => {
    const note = `it's "so" $HOME \\ # 1; é`, text = stack_text('one\ntwo', 'ROKVISS', [{subsystem: 'ARM', function: 'SET', values: {MODE: 4, GOAL: [0.5, -1], NOTE: note}}]);
    assert.deepEqual(read_stack(text, find), {rows: [{subsystem: 'ARM', function: 'SET', texts: {MODE: '4', GOAL: '0.5 -1', NOTE: note}}]});
  });

  it('takes what hirosco tc takes: small letters, arguments by their places, values by their names', () => {
    assert.deepEqual(read_stack('arm set safe-operational note="a \\"b" 1,2  # so', find).rows[0].texts, {MODE: '4', NOTE: 'a "b', GOAL: '1 2'});
  });

  it('says which line is wrong, and why, and takes nothing of it', () => {
    for (const [text, why] of [['arm', /line 1: "arm" is no line of "hirosco tc/], ['\n# so\nhirosco tc leg SET', /line 3: there is no subsystem leg/], [`arm set 'a`, /line 1: a quote is not closed/],
      ['arm set 1 2 3 4', /line 1: SET has 3 arguments, and "4" is none/], ['arm set\n'.repeat(most_rows + 1), new RegExp(`line ${most_rows + 1}: more than`)], ['x'.repeat(1e6), /longer than/]]) {
      assert.match(read_stack(text, find).problem, why);
    }
    assert.deepEqual(words_of(`a 'b c'\\ d "" #e`), ['a', 'b c d', '']);
  });
});

describe('the next picture', () => {
  it('waits its turn also when drawing itself asks for it, and comes after a picture that failed', async () => {
    const asked = [];
    Object.assign(globalThis, {matchMedia: () => ({matches: false}), requestAnimationFrame: (draw) => asked.push(draw), cancelAnimationFrame: () => {}});
    const {Pace} = await of_page('scene/pace.js');
    let drawn = 0;
    const pace = new Pace(() => {
      pace.soon();
      if (++drawn === 2) throw new Error('of the picture');
      return {unfinished: true, moving: true};
    }, false);
    const again = async () => { while (!asked.length) await new Promise((resolve) => setImmediate(resolve)); };
    pace.soon();
    asked.shift()();
    assert.equal(asked.length, 0);
    await again();
    assert.throws(asked.shift(), /of the picture/);
    await again();
    asked.shift()();
    assert.equal(drawn, 3);
    pace.close();
  });
});

describe('triangles that a processor draws', () => {
  const white = [254, 254, 254, 1];
  let raster;
  before(async () => {
    globalThis.ImageData = class { constructor(width, height) { Object.assign(this, {width, height, data: new Uint8ClampedArray(4 * width * height)}); } };
    raster = new (await of_page('scene/raster.js')).Raster();
  });
  /// `corners`: [x, y, depth, red, green, blue, opacity] each.
  const draw = (corners, how = {}) => {
    const c = raster.room(corners.length);
    corners.forEach((one, i) => [...one, 0, 0].slice(0, 9).forEach((value, k) => { c[9 * i + k] = value; }));
    raster.triangles(null, corners.length, {side: 0, ...how});
  };
  const at = (x, y) => [...raster.image.data.slice(4 * (y * raster.width + x), 4 * (y * raster.width + x) + 4)];
  const square = ([x0, y0, x1, y1], depth, colour) => {
    const [a, b, c, d] = [[x0, y0], [x1, y0], [x1, y1], [x0, y1]].map((place) => [...place, depth, ...colour]);
    return [a, b, c, a, c, d];
  };

  it('cover each point whose middle is in them, once, whatever edge they share', () => {
    raster.begin(40, 30);
    draw(square([3.2, 4.7, 20.6, 17.4], 0, [...white.slice(0, 3), 0.5]), {write: 'blend', keep: false});
    const covered = [...raster.points].filter(Boolean);
    // Middles from 3.5 to 20.5 and from 5.5 to 16.5; a point that was drawn twice would be less clear.
    assert.equal(covered.length, 18 * 12);
    assert.deepEqual([...new Set(covered.map((one) => one >>> 24))], [128]);
    assert.deepEqual(raster.drawn(), {left: 3, top: 5, width: 18, height: 12});
  });

  it('hide what is farther, also where they show nothing themselves', () => {
    raster.begin(40, 30);
    draw(square([0, 0, 20, 30], -0.5, white), {write: ''});
    draw(square([0, 0, 40, 30], 0, [200, 10, 20, 1]));
    assert.deepEqual(at(10, 10), [0, 0, 0, 0]);
    assert.deepEqual(at(30, 10), [200, 10, 20, 255]);
    draw(square([0, 0, 40, 30], 0.5, white));
    assert.deepEqual(at(30, 10), [200, 10, 20, 255]);
  });

  it('go from corner to corner in colour', () => {
    raster.begin(100, 2);
    draw([[0, -50, 0, 0, 0, 0, 1], [200, 1, 0, 200, 100, 50, 1], [0, 52, 0, 0, 0, 0, 1]]);
    for (const x of [10, 50, 90]) near(at(x, 1).slice(0, 3).map((value) => value / 255), [200, 100, 50].map((value) => Math.floor(value * (x + 0.5) / 200) / 255));
  });

  it('mix with what is there by their opacity; of shadows the darkest counts', () => {
    raster.begin(4, 4);
    draw(square([0, 0, 4, 4], 0, [200, 200, 200, 1]));
    draw(square([0, 0, 4, 4], -0.1, [0, 100, 0, 0.25]), {write: 'blend', keep: false});
    assert.deepEqual(at(1, 1), [150, 175, 150, 255]);
    raster.begin(4, 4);
    for (let i = 0; i < 2; ++i) draw(square([0, 0, 4, 4], 0, [0, 0, 0, 0.4]), {write: 'darkest', keep: false});
    assert.deepEqual(at(1, 1), [0, 0, 0, 102]);
  });

  it('leave out what is behind the eye, out of the picture, or turned away', () => {
    raster.begin(8, 8);
    draw([[NaN, NaN, NaN, ...white], [8, 0, 0, ...white], [0, 8, 0, ...white]]);
    draw(square([-500, -500, -2, 800], 0, white));
    draw([[0, 0, 0, ...white], [8, 0, 0, ...white], [0, 8, 0, ...white]], {side: 1});
    assert.equal(raster.drawn(), null);
    draw([[0, 0, 0, ...white], [8, 0, 0, ...white], [0, 8, 0, ...white]], {side: -1});
    assert.deepEqual(at(1, 1), [254, 254, 254, 255]);
    raster.begin(8, 8);
    assert.ok(raster.points.every((one) => one === 0));
  });
});

describe('the bundle', () => {
  it('is smaller than 120 kB without 3D and 350 kB in all, compressed', () => {
    const sizes = readdirSync(page_folder).filter((name) => /\.(js|css|html)$/.test(name))
        .map((name) => [name, gzipSync(readFileSync(join(page_folder, name))).length]);
    const sum = (list) => list.reduce((total, [, size]) => total + size, 0);
    const without = sum(sizes.filter(([name]) => !/^(robot_|card)/.test(name)));
    console.log(`measured: ${(without / 1000).toFixed(0)} kB without 3D, ${(sum(sizes) / 1000).toFixed(0)} kB in all`);
    assert.ok(without < 120e3);
    assert.ok(sum(sizes) < 350e3);
  });

  it('holds no address of another host that it would ask', () => {
    const html_text = readFileSync(join(page_folder, 'index.html'), 'utf8');
    assert.doesNotMatch(html_text, /https?:\/\//);
    assert.doesNotMatch(html_text, /<script(?![^>]*src=)/);
  });
});
