// Copyright (c) 2026, the planecloud_slam authors
// SPDX-License-Identifier: BSD-3-Clause
//
// Owns the precompiled headers of the unit tests: a third of their compile time.
int main() { return 0; }
