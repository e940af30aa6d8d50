# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""How far the links of a robot are apart by coal, on the meshes as they are, along straight paths of its joints. Nothing of ours is in it but
which pairs are asked for, and why, is said here:

Two links of which one carries the other by one joint are no pair, nor are two that are one body. Two that are less than TOUCH apart with the joints
between them at 0, where these may be there, and what is somebody else's at 0 as well, or never farther apart in 300 random postures, were built touching. What is never 40 mm apart is
free where it is half as far as it ever is; everything else where it is 20 mm."""
import itertools

import coal
import numpy
import pinocchio

FREE_M, TOUCH_M = 0.020, 0.002
POSTURES = 300
# Of any point, between two looks at a pair that is about to touch.
STEP_M = 0.001


class Pair:
    def __init__(self, one, other, names):
        self.one, self.other, self.names = one, other, names
        self.free_m = FREE_M
        self.request, self.result = coal.DistanceRequest(), coal.DistanceResult()


class Judge:
    def __init__(self, urdf, joints, stands, mimics):
        """`joints`: (name, lower, upper) of the coordinates that are asked for, `stands`: where those stand that are somebody else's, `mimics`: who follows whom."""
        self.model = pinocchio.buildModelFromUrdf(str(urdf))
        self.geometry = pinocchio.buildGeomFromUrdf(self.model, str(urdf), pinocchio.COLLISION, package_dirs=[str(urdf.parent)])
        self.data, self.places = self.model.createData(), pinocchio.GeometryData(self.geometry)
        self.names = [name for name, _, _ in joints]
        self.lower, self.upper = (numpy.array([joint[i] for joint in joints]) for i in (1, 2))
        self.mimics, self.stands = mimics, stands
        self.body = [0] * self.model.njoints  # whose body the one of a joint is
        for joint in range(1, self.model.njoints):
            self.body[joint] = self.body[self.model.parents[joint]] if self.model.names[joint] in stands else joint
        self.find_pairs()

    def chain(self, joint):
        """Joints that move this one's body, from the base on."""
        found = []
        while (joint := self.body[joint]) != 0:
            found.insert(0, joint)
            joint = self.model.parents[joint]
        return found

    def find_pairs(self):
        links = {}
        for index, shape in enumerate(self.geometry.geometryObjects):
            links.setdefault(self.model.frames[shape.parentFrame].name, []).append(index)
        self.pairs = []
        for (one, its), (other, others) in itertools.combinations(links.items(), 2):
            chains = [self.chain(self.geometry.geometryObjects[shapes[0]].parentJoint) for shapes in (its, others)]
            shared = len([pair for pair in zip(*chains) if pair[0] == pair[1]])
            between = chains[0][shared:] + chains[1][shared:]
            if len(between) <= 1:
                continue
            pair = Pair(its, others, f"{one} and {other}")
            pair.between = between
            pair.reach = self.reach_of(pair, [chains[0][shared:], chains[1][shared:]])
            self.pairs.append(pair)

    def reach_of(self, pair, chains):
        """By coordinate, how far a point of either is from that joint at most."""
        reach = numpy.zeros(len(self.names))
        for chain, shapes in zip(chains, (pair.one, pair.other)):
            out = 0
            for shape in shapes:
                found = self.geometry.geometryObjects[shape]
                found.geometry.computeLocalAABB()
                far = numpy.linalg.norm(found.placement.translation) + numpy.linalg.norm(found.geometry.aabb_center) + found.geometry.aabb_radius
                stood = found.parentJoint
                while self.body[stood] != stood:
                    far += numpy.linalg.norm(self.model.jointPlacements[stood].translation) + abs(self.stands[self.model.names[stood]])
                    stood = self.model.parents[stood]
                out = max(out, far)
            for joint in reversed(chain):
                name = self.model.names[joint]
                coordinate = self.names.index(self.mimics.get(name, name)) if self.mimics.get(name, name) in self.names else None
                slides = "P" in self.model.joints[joint].shortname()
                if coordinate is not None:
                    reach[coordinate] += 1 if slides else out
                if slides and coordinate is not None:
                    out += self.upper[coordinate] - self.lower[coordinate]
                out += abs(self.stands.get(self.mimics.get(name, name), 0)) if slides else 0
                out += numpy.linalg.norm(self.model.jointPlacements[joint].translation)
        return reach

    def place(self, q, stands=None):
        full = pinocchio.neutral(self.model)
        values = {**(self.stands if stands is None else stands), **dict(zip(self.names, q))}
        values.update({follower: values[leader] for follower, leader in self.mimics.items()})
        for name, value in values.items():
            joint = self.model.joints[self.model.getJointId(name)]
            if joint.nq == 2:
                full[joint.idx_q], full[joint.idx_q + 1] = numpy.cos(value), numpy.sin(value)
            else:
                full[joint.idx_q] = value
        pinocchio.updateGeometryPlacements(self.model, self.data, self.geometry, self.places, full)

    def apart(self, pair):
        least = numpy.inf
        for one, other in itertools.product(pair.one, pair.other):
            pair.result.clear()
            its, others = self.places.oMg[one], self.places.oMg[other]
            least = min(least, coal.distance(
                self.geometry.geometryObjects[one].geometry, coal.Transform3s(its.rotation, its.translation),
                self.geometry.geometryObjects[other].geometry, coal.Transform3s(others.rotation, others.translation),
                pair.request, pair.result))
        return least

    def learn(self, random):
        """Which pairs are none, and from where on the others are free. What it says is printed."""
        farthest = numpy.zeros(len(self.pairs))
        for _ in range(POSTURES):
            self.place(self.anywhere(random))
            # Whoever was far away once need not be looked at again.
            for i, pair in enumerate(self.pairs):
                if farthest[i] < 2 * FREE_M:
                    farthest[i] = max(farthest[i], self.apart(pair))
        self.place(numpy.zeros(len(self.names)), dict.fromkeys(self.stands, 0.0))
        kept, said = [], []
        for pair, far in zip(self.pairs, farthest):
            leaders = [self.mimics.get(self.model.names[joint], self.model.names[joint]) for joint in pair.between]
            ranges = [(self.lower[i], self.upper[i]) for i in (self.names.index(name) for name in leaders if name in self.names)]
            at_zero = self.apart(pair) if all(low <= 0 <= high for low, high in ranges) else numpy.inf
            if min(at_zero, far) < TOUCH_M:
                said.append(f"built touching: {pair.names}")
                continue
            pair.free_m = min(FREE_M, far / 2)
            if pair.free_m < FREE_M:
                said.append(f"never more than {1e3 * far:.1f} mm apart, free from {1e3 * pair.free_m:.1f} mm on: {pair.names}")
            kept.append(pair)
        self.pairs = kept
        return said

    def anywhere(self, random):
        return random.uniform(numpy.maximum(self.lower, -numpy.pi), numpy.minimum(self.upper, numpy.pi))

    def is_free(self, q):
        self.place(q)
        return all(self.apart(pair) >= pair.free_m for pair in self.pairs)

    def touches(self, start, goal):
        for share in numpy.linspace(0.1, 1, 10):
            self.place(start + share * (goal - start))
            if any(self.apart(pair) <= 0 for pair in self.pairs):
                return True
        return False

    def path(self, start, goal):
        """free, near or colliding, and by whom: each pair is looked at again as soon as it can have come so near as to matter."""
        way = goal - start
        verdict, whom = "free", ""
        # At which share of the way next, from which distance on it matters.
        for pair in sorted(self.pairs, key=lambda pair: -float(pair.reach @ numpy.abs(way))):
            length = float(pair.reach @ numpy.abs(way))
            if length == 0:
                continue
            share, matters = 0.0, pair.free_m
            while True:
                self.place(start + share * way)
                far = self.apart(pair)
                if far <= 0:
                    return "colliding", pair.names
                if far < pair.free_m:
                    verdict, whom, matters = "near", pair.names, 0.0
                if share >= 1:
                    break
                share = min(1.0, share + max(far - matters, STEP_M) / length)
        return verdict, whom

    def contact(self, trail):
        """The first pair in contact on this polygon of postures; none: \"\"."""
        for pair in self.pairs:
            left, last = 0.0, trail[0]
            for q in trail:
                left -= float(pair.reach @ numpy.abs(q - last))
                last = q
                if left > 0:
                    continue
                self.place(q)
                if (left := self.apart(pair)) <= 0:
                    return pair.names
        return ""
