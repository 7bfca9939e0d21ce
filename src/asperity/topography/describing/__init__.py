"""What a surface is: summits, spectrum, distribution, and two as one."""
