// SPDX-License-Identifier: MIT
// The translation unit of the precompiled header of the tests.
