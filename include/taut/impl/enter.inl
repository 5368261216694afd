// SPDX-License-Identifier: MIT
// The first line of each public header. How many of them are open: the outermost one includes the bodies at its end,
// where all declarations are complete (leave.inl).
#if !defined(TAUT_OPEN)
#define TAUT_OPEN 1
#elif TAUT_OPEN == 1
#undef TAUT_OPEN
#define TAUT_OPEN 2
#elif TAUT_OPEN == 2
#undef TAUT_OPEN
#define TAUT_OPEN 3
#elif TAUT_OPEN == 3
#undef TAUT_OPEN
#define TAUT_OPEN 4
#elif TAUT_OPEN == 4
#undef TAUT_OPEN
#define TAUT_OPEN 5
#elif TAUT_OPEN == 5
#undef TAUT_OPEN
#define TAUT_OPEN 6
#elif TAUT_OPEN == 6
#undef TAUT_OPEN
#define TAUT_OPEN 7
#elif TAUT_OPEN == 7
#undef TAUT_OPEN
#define TAUT_OPEN 8
#elif TAUT_OPEN == 8
#undef TAUT_OPEN
#define TAUT_OPEN 9
#elif TAUT_OPEN == 9
#undef TAUT_OPEN
#define TAUT_OPEN 10
#elif TAUT_OPEN == 10
#undef TAUT_OPEN
#define TAUT_OPEN 11
#elif TAUT_OPEN == 11
#undef TAUT_OPEN
#define TAUT_OPEN 12
#elif TAUT_OPEN == 12
#undef TAUT_OPEN
#define TAUT_OPEN 13
#elif TAUT_OPEN == 13
#undef TAUT_OPEN
#define TAUT_OPEN 14
#elif TAUT_OPEN == 14
#undef TAUT_OPEN
#define TAUT_OPEN 15
#elif TAUT_OPEN == 15
#undef TAUT_OPEN
#define TAUT_OPEN 16
#elif TAUT_OPEN == 16
#undef TAUT_OPEN
#define TAUT_OPEN 17
#elif TAUT_OPEN == 17
#undef TAUT_OPEN
#define TAUT_OPEN 18
#elif TAUT_OPEN == 18
#undef TAUT_OPEN
#define TAUT_OPEN 19
#elif TAUT_OPEN == 19
#undef TAUT_OPEN
#define TAUT_OPEN 20
#elif TAUT_OPEN == 20
#undef TAUT_OPEN
#define TAUT_OPEN 21
#elif TAUT_OPEN == 21
#undef TAUT_OPEN
#define TAUT_OPEN 22
#elif TAUT_OPEN == 22
#undef TAUT_OPEN
#define TAUT_OPEN 23
#elif TAUT_OPEN == 23
#undef TAUT_OPEN
#define TAUT_OPEN 24
#elif TAUT_OPEN == 24
#undef TAUT_OPEN
#define TAUT_OPEN 25
#elif TAUT_OPEN == 25
#undef TAUT_OPEN
#define TAUT_OPEN 26
#elif TAUT_OPEN == 26
#undef TAUT_OPEN
#define TAUT_OPEN 27
#elif TAUT_OPEN == 27
#undef TAUT_OPEN
#define TAUT_OPEN 28
#elif TAUT_OPEN == 28
#undef TAUT_OPEN
#define TAUT_OPEN 29
#elif TAUT_OPEN == 29
#undef TAUT_OPEN
#define TAUT_OPEN 30
#elif TAUT_OPEN == 30
#undef TAUT_OPEN
#define TAUT_OPEN 31
#elif TAUT_OPEN == 31
#undef TAUT_OPEN
#define TAUT_OPEN 32
#elif TAUT_OPEN == 32
#undef TAUT_OPEN
#define TAUT_OPEN 33
#elif TAUT_OPEN == 33
#undef TAUT_OPEN
#define TAUT_OPEN 34
#elif TAUT_OPEN == 34
#undef TAUT_OPEN
#define TAUT_OPEN 35
#elif TAUT_OPEN == 35
#undef TAUT_OPEN
#define TAUT_OPEN 36
#elif TAUT_OPEN == 36
#undef TAUT_OPEN
#define TAUT_OPEN 37
#elif TAUT_OPEN == 37
#undef TAUT_OPEN
#define TAUT_OPEN 38
#elif TAUT_OPEN == 38
#undef TAUT_OPEN
#define TAUT_OPEN 39
#elif TAUT_OPEN == 39
#undef TAUT_OPEN
#define TAUT_OPEN 40
#elif TAUT_OPEN == 40
#undef TAUT_OPEN
#define TAUT_OPEN 41
#elif TAUT_OPEN == 41
#undef TAUT_OPEN
#define TAUT_OPEN 42
#elif TAUT_OPEN == 42
#undef TAUT_OPEN
#define TAUT_OPEN 43
#elif TAUT_OPEN == 43
#undef TAUT_OPEN
#define TAUT_OPEN 44
#elif TAUT_OPEN == 44
#undef TAUT_OPEN
#define TAUT_OPEN 45
#elif TAUT_OPEN == 45
#undef TAUT_OPEN
#define TAUT_OPEN 46
#elif TAUT_OPEN == 46
#undef TAUT_OPEN
#define TAUT_OPEN 47
#elif TAUT_OPEN == 47
#undef TAUT_OPEN
#define TAUT_OPEN 48
#endif
