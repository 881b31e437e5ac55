// SPDX-License-Identifier: Apache-2.0
// SOURCE: the values of SegmentSource (plan/plan.h), from which colour and opacity are computed.
#define SOURCE_CONSTANT 0
#define SOURCE_TABLE 1
#define SOURCE_PARTS 2
#define SOURCE_CUT_TABLE 3
#define SOURCE_ANALYTIC 4
#define SOURCE_MEAN 5
#define SOURCE_VERTICES 6
#if SOURCE == SOURCE_CONSTANT
uniform vec4 constant_optics;  // colour, extinction
#endif
