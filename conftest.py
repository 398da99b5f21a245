"""What holds for all Python tests."""

import os

from unshade.render import llvm

# A test that asks for a picture gets one that was rendered for it.
os.environ["UNSHADE_RENDER_CACHE"] = "off"

# One variant, and one LLVM, for every test: set before anything imports Mitsuba, which would take any LLVM.
llvm.activate(llvm.choose("llvm_ad_rgb"))
