"""What a surface is: summits, spectrum, distribution of heights, and two surfaces as one."""
