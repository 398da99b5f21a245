"""What holds for all Python tests."""

import os

# A test that asks for a picture gets one that was rendered for it.
os.environ["UNSHADE_RENDER_CACHE"] = "off"
