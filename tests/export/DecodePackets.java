// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import java.io.BufferedReader;
import java.io.InputStreamReader;
import java.util.ArrayList;
import java.util.HexFormat;
import java.util.List;
import java.util.Map;

import org.yamcs.YConfiguration;
import org.yamcs.events.EventProducerFactory;
import org.yamcs.mdb.Mdb;
import org.yamcs.mdb.MdbFactory;
import org.yamcs.mdb.XtceTmExtractor;
import org.yamcs.parameter.AggregateValue;
import org.yamcs.parameter.ArrayValue;
import org.yamcs.parameter.ContainerParameterValue;
import org.yamcs.parameter.Value;
import org.yamcs.utils.TimeEncoding;

/** Reads packets in hexadecimal, one a line, and prints what Yamcs makes of each by the database: path, bits, raw value, a line each. */
public class DecodePackets {
    public static void main(String[] arguments) throws Exception {
        TimeEncoding.setUp();
        EventProducerFactory.setMockup(false);
        YConfiguration tree = YConfiguration.wrap(Map.of("type", "xtce", "args", Map.of("file", arguments[0])));
        Mdb mdb = MdbFactory.createInstance(List.of(tree), false, false);
        XtceTmExtractor extractor = new XtceTmExtractor(mdb);
        extractor.provideAll();
        BufferedReader input = new BufferedReader(new InputStreamReader(System.in));
        StringBuilder out = new StringBuilder();
        for (String line = input.readLine(); line != null; line = input.readLine()) {
            byte[] packet = HexFormat.of().parseHex(line.strip());
            var result = extractor.processPacket(packet, 0, 0, 0);
            out.append("packet\n");
            for (var any : result.getTmParams()) {
                var value = (ContainerParameterValue) any;
                out.append(value.getParameter().getQualifiedName()).append('\t').append(value.getAbsoluteBitOffset()).append('\t')
                        .append(value.getBitSize()).append('\t').append(text(value.getRawValue())).append('\n');
            }
        }
        System.out.print(out);
    }

    static String text(Value value) {
        List<String> parts = new ArrayList<>();
        collect(value, parts);
        return String.join(" ", parts);
    }

    static void collect(Value value, List<String> parts) {
        if (value instanceof ArrayValue array) {
            for (int i = 0; i < array.flatLength(); i++) {
                collect(array.getElementValue(i), parts);
            }
            return;
        }
        if (value instanceof AggregateValue aggregate) {
            for (int i = 0; i < aggregate.numMembers(); i++) {
                collect(aggregate.getMemberValue(i), parts);
            }
            return;
        }
        switch (value.getType()) {
        case FLOAT -> parts.add("f" + Integer.toHexString(Float.floatToRawIntBits(value.getFloatValue())));
        case DOUBLE -> parts.add("d" + Long.toHexString(Double.doubleToRawLongBits(value.getDoubleValue())));
        case BINARY -> parts.add("x" + HexFormat.of().formatHex(value.getBinaryValue()));
        case STRING -> parts.add("x" + HexFormat.of().formatHex(value.getStringValue().getBytes(java.nio.charset.StandardCharsets.UTF_8)));
        case UINT64 -> parts.add(Long.toUnsignedString(value.getUint64Value()));
        case UINT32 -> parts.add(Integer.toUnsignedString(value.getUint32Value()));
        default -> parts.add(value.toString());
        }
    }
}
