// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0
import htm from 'htm';
import {h} from 'preact';
import '@preact/signals';

/// Templates without a compiler. What stands in ${} becomes a text node or an attribute, never markup.
export const html = htm.bind(h);
