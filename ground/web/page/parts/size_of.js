// SPDX-FileCopyrightText: 2026 The HIROSCO developers
// SPDX-License-Identifier: Apache-2.0

/// The size of a vector of parameters, as the name of a curve (curves.js).
export const size_of = (names) => names.length > 1 ? `=hypot(${names.join(', ')})` : `=abs(${names[0]})`;
