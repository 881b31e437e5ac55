// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace lamina::patterson {

// Patterson's nested extensions of the 3-point Gauss-Legendre rule (Patterson 1968, Math. Comp. 22,
// 847-856), exact to degree 5, 11 and 23: entry 0 is the centre, entry i > 0 the pair 1/2 +-
// node[i] of [0, 1].
inline constexpr double node[8] = {0,
                                   0.3872983346207416885,
                                   0.2171218746734012790,
                                   0.4802456343540101417,
                                   0.1116933432144834408,
                                   0.3105514733686132015,
                                   0.4442296164361284994,
                                   0.4969159816063775111};
inline constexpr double weight3[2] = {0.4444444444444444444, 0.2777777777777777778};
inline constexpr double weight7[4] = {0.2254582693292370712, 0.1342440449341667204,
                                      0.2006987073879811115, 0.0523281130132336326};
inline constexpr double weight15[8] = {
    0.1127552498991033437, 0.06720762762189211018, 0.1003142646884945105,  0.02580164149853986985,
    0.1095784292007937482, 0.08575595456819569039, 0.04646359765756226884, 0.00850085981497013017};

}  // namespace lamina::patterson
