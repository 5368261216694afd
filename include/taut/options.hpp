// SPDX-License-Identifier: MIT
#pragma once

/// Common types of all entry points: limits of a run, progress and cancellation, precision.
#include <taut/impl/core/observer.hpp>
#include <taut/impl/objective/precision.hpp>
#include <taut/impl/objective/stage_report.hpp>
