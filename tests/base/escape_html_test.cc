// SPDX-FileCopyrightText: 2026 The Plumbline authors
// SPDX-License-Identifier: Apache-2.0
#include "plumbline/base/escape_html.h"

#include <gtest/gtest.h>

namespace plumbline {
namespace {

TEST(EscapeHtml, LeavesNothingThatHtmlWouldRead) {
  EXPECT_EQ(EscapeHtml("<b title=\"x\">'1 & 2'</b>"),
            "&lt;b title=&quot;x&quot;&gt;&#39;1 &amp; 2&#39;&lt;/b&gt;");
  EXPECT_EQ(EscapeHtml("plain text, ü"), "plain text, ü");
}

}  // namespace
}  // namespace plumbline
