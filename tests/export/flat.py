# SPDX-FileCopyrightText: 2026 The HIROSCO developers
# SPDX-License-Identifier: Apache-2.0
"""An XTCE database without what `space_packet_parser` does not know: nested space systems, arrays, repeated and indirect entries,
names of values. Nothing of what a bit means is decided here: names become paths, a repetition becomes as many entries, and where a
packet says how many there are, or which parameter it is, there is a container for each answer that was asked for."""
import copy
import xml.etree.ElementTree as ET

NAMESPACE = "http://www.omg.org/spec/XTCE/20180204"
Q = f"{{{NAMESPACE}}}"


class Flat:
    def __init__(self, document):
        self.types, self.parameters, self.containers, self.aliases = {}, {}, {}, {}
        self.choices = {}                  # container: {value that a packet had}
        self.asked = {}                    # parameter: containers that wait for its value
        self.root = None
        self._read(document, "")

    def _read(self, system, parent):
        path = f"{parent}/{system.get('name')}"
        for kind, known in (("ParameterTypeSet", self.types), ("ParameterSet", self.parameters),
                            ("ContainerSet", self.containers)):
            for one in system.findall(f"{Q}TelemetryMetaData/{Q}{kind}/*"):
                known[f"{path}/{one.get('name')}"] = one
        for name, parameter in self.parameters.items():
            for alias in parameter.iter(f"{Q}Alias"):
                self.aliases[alias.get("alias")] = name
        for child in system.findall(f"{Q}SpaceSystem"):
            self._read(child, path)

    def is_second_look(self, container):
        """It reads again what was read before."""
        entries = container.findall(f"{Q}EntryList/*")
        return bool(entries) and all(entry.find(f"{Q}LocationInContainerInBits") is not None for entry in entries)

    def document(self):
        """The flat database as octets."""
        self.asked = {}
        self.out = ET.Element(f"{Q}SpaceSystem", name="flat")
        telemetry = ET.SubElement(self.out, f"{Q}TelemetryMetaData")
        self.out_types = ET.SubElement(telemetry, f"{Q}ParameterTypeSet")
        self.out_parameters = ET.SubElement(telemetry, f"{Q}ParameterSet")
        self.out_containers = ET.SubElement(telemetry, f"{Q}ContainerSet")
        self.made = set()
        bases = {container.find(f"{Q}BaseContainer").get("containerRef") for container in self.containers.values()
                 if container.find(f"{Q}BaseContainer") is not None}
        for name, container in self.containers.items():
            base = container.find(f"{Q}BaseContainer")
            if base is None and name not in bases:
                continue                   # only ever included
            if self.is_second_look(container) or (base is not None and
                                                  self.is_second_look(self.containers[base.get("containerRef")])):
                continue
            if base is None:
                self.root = name
            self._add_container(name, [(entry, "") for entry in container.findall(f"{Q}EntryList/*")], base)
        ET.register_namespace("", NAMESPACE)
        return ET.tostring(self.out)

    def _add_container(self, name, entries, base):
        made = ET.SubElement(self.out_containers, f"{Q}SequenceContainer", name=name)
        listed = ET.SubElement(made, f"{Q}EntryList")
        if base is not None:
            made.append(base)
        while entries:
            (entry, suffix), entries = entries[0], entries[1:]
            tag = entry.tag[len(Q):]
            if tag == "ParameterRefEntry":
                for parameter in self._add_parameter(entry.get("parameterRef"), suffix):
                    ET.SubElement(listed, f"{Q}ParameterRefEntry", parameterRef=parameter)
                continue
            if tag == "IndirectParameterRefEntry":
                asked = entry.find(f"{Q}ParameterInstance").get("parameterRef") + suffix
                answers = {value: self._indirect(value, suffix) for value in self.choices.get(name, ())}
            else:
                count = entry.find(f"{Q}RepeatEntry/{Q}Count")
                item = self.containers[entry.get("containerRef")].findall(f"{Q}EntryList/*")
                fixed = count.find(f"{Q}FixedValue")
                if fixed is not None:
                    entries = self._times(item, int(fixed.text), suffix) + entries
                    continue
                asked = count.find(f"{Q}DynamicValue/{Q}ParameterInstanceRef").get("parameterRef") + suffix
                answers = {value: self._times(item, value, suffix) for value in self.choices.get(name, ())}
            self.asked.setdefault(asked, []).append(name)
            for value, answer in answers.items():
                self._add_container(f"{name}({value})", answer + entries, self._when(name, asked, value))
            return

    @staticmethod
    def _times(item, count, suffix):
        return [(entry, f"{suffix}#{number}") for number in range(count) for entry in item]

    def _indirect(self, value, suffix):
        return [(ET.Element(f"{Q}ParameterRefEntry", parameterRef=self.aliases[str(value)]), suffix)]

    @staticmethod
    def _when(container, parameter, value):
        base = ET.Element(f"{Q}BaseContainer", containerRef=container)
        criteria = ET.SubElement(base, f"{Q}RestrictionCriteria")
        ET.SubElement(criteria, f"{Q}Comparison", parameterRef=parameter, value=str(value), useCalibratedValue="false")
        return base

    def _add_parameter(self, path, suffix):
        """Names of the parameters that stand for this one: each element of an array, each member of a structure."""
        return self._expand(path, suffix, self.parameters[path].get("parameterTypeRef"))

    def _expand(self, path, suffix, type_path):
        kind = self.types[type_path]
        if kind.tag == f"{Q}ArrayParameterType":
            last = int(kind.find(f"{Q}DimensionList/{Q}Dimension/{Q}EndingIndex/{Q}FixedValue").text)
            return [self._make(f"{path}[{i}]{suffix}", kind.get("arrayTypeRef")) for i in range(last + 1)]
        if kind.tag == f"{Q}AggregateParameterType":
            return [name for member in kind.iter(f"{Q}Member")
                    for name in self._expand(f"{path}.{member.get('name')}", suffix, member.get("typeRef"))]
        behind = kind.find(f"{Q}StringDataEncoding/{Q}Variable/{Q}LeadingSize")
        if behind is not None:
            length, words = self._words_behind(path + suffix, int(behind.get("sizeInBitsOfSizeTag")))
            return [length, words]
        return [self._make(path + suffix, type_path)]

    def _words_behind(self, name, bits):
        """A number, and words of that many octets."""
        length = f"{name}:length"
        for one, tag, encoding in ((length, "Integer", {"sizeInBits": str(bits)}), (name, "String", {"encoding": "UTF-8"})):
            if one in self.made:
                continue
            self.made.add(one)
            kind = ET.SubElement(self.out_types, f"{Q}{tag}ParameterType", name=f"type of {one}")
            made = ET.SubElement(kind, f"{Q}{tag}DataEncoding", encoding)
            if tag == "String":
                size = ET.SubElement(ET.SubElement(made, f"{Q}Variable", maxSizeInBits="65536"), f"{Q}DynamicValue")
                ET.SubElement(size, f"{Q}ParameterInstanceRef", parameterRef=length)
                ET.SubElement(size, f"{Q}LinearAdjustment", slope="8", intercept="0")
            ET.SubElement(self.out_parameters, f"{Q}Parameter", name=one, parameterTypeRef=f"type of {one}")
        return length, name

    def _make(self, name, type_path):
        if name not in self.made:
            self.made.add(name)
            ET.SubElement(self.out_parameters, f"{Q}Parameter", name=name, parameterTypeRef=self._make_type(type_path))
        return name

    def _make_type(self, path):
        kind = copy.deepcopy(self.types[path])
        if kind.tag == f"{Q}EnumeratedParameterType":
            kind.tag = f"{Q}IntegerParameterType"     # one without a name is no fault of the packet
            kind.remove(kind.find(f"{Q}EnumerationList"))
        kind.set("name", path)
        if path not in self.made:
            self.made.add(path)
            self.out_types.append(kind)
        return path
