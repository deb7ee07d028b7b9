"""References of this program and of the paper whose method it implements, as BibTeX."""

from hsr8.version import VERSION

YEAR = 2026
BIBTEX = f"""@software{{hsr8,
  author  = {{{{hsr8 maintainers}}}},
  title   = {{hsr8: full-body simulator of a humanoid robot that navigates among moving obstacles}},
  version = {{{VERSION}}},
  year    = {{{YEAR}}},
  license = {{Apache-2.0}},
}}

@inproceedings{{yoo2010navigation,
  author    = {{Yoo, Jeong-Ki and Kim, Jong-Hwan}},
  title     = {{Navigation Framework for Humanoid Robots Integrating Gaze Control and
               Modified-univector Field Method to Avoid Dynamic Obstacles}},
  booktitle = {{Proc. IEEE/RSJ International Conference on Intelligent Robots and Systems (IROS)}},
  address   = {{Taipei, Taiwan}},
  year      = {{2010}},
  month     = oct,
  pages     = {{1683--1689}},
}}
"""
